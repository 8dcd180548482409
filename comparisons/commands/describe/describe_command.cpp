#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>
#include <array>
#include <map>
#include <string>
#include <vector>

#include "comparisons/commands/commands.h"
#include "comparisons/reproduce/figures.h"
#include "comparisons/sweep/find_cases.h"
#include "msm/parameters/model_options.h"
#include "msm/parameters/model_table.h"
#include "problem/case_file/keys.h"
#include "problem/system/streams.h"

namespace springproof {
namespace {

/// Known values of an option ("--model") or of a positional argument ("CASE").
using KnownValues = std::map<std::string, std::vector<std::string>>;

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App* command) { return !command->get_group().empty(); });
}

std::vector<const CLI::Option*> options_of(const CLI::App& command) {
  return command.get_options([](const CLI::Option* option) { return option->nonpositional(); });
}

std::vector<const CLI::Option*> positionals_of(const CLI::App& command) {
  return command.get_options([](const CLI::Option* option) { return option->get_positional(); });
}

bool takes_value(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

/// -E, --youngs-modulus
std::vector<std::string> spellings(const CLI::Option& option) {
  std::vector<std::string> all;
  for (const std::string& name : option.get_snames()) all.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) all.push_back("--" + name);
  return all;
}

std::string replaced(std::string text, char from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) text.replace(at, 1, to);
  return text;
}

/// Escapes text so that roff prints it unchanged.
std::string roff(const std::string& text) {
  const std::string plain = replaced(replaced(text, '\\', "\\e"), '-', "\\-");
  return plain.starts_with('.') || plain.starts_with('\'') ? "\\&" + plain : plain;
}

/// The positional arguments, " CASE...".
std::string places(const CLI::App& command) {
  std::string text;
  for (const CLI::Option* option : positionals_of(command)) {
    const std::string name = option->get_name(true) + (option->get_items_expected_max() > 1 ? "..." : "");
    text += option->get_required() ? " " + name : " [" + name + "]";
  }
  return text;
}

std::string man_entry(const std::string& term, const CLI::Option& option) {
  const std::string known = option.get_default_str();
  return fmt::format(".TP\n{}\n{}{}\n", term, roff(option.get_description()),
                     known.empty() ? "" : roff(" (default: " + known + ")"));
}

std::string man_option(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : spellings(option)) names.push_back("\\fB" + roff(name) + "\\fR");
  const std::string type = option.get_type_name();
  const std::string value = takes_value(option) ? " \\fI" + roff(type.substr(0, type.find(':'))) + "\\fR" : "";
  return man_entry(fmt::format("{}{}", fmt::join(names, ", "), value), option);
}

std::string man_command(const CLI::App& command) {
  std::string text = fmt::format(".SS springproof {}{}\n{}\n", roff(command.get_name()), roff(places(command)),
                                 roff(command.get_description()));
  for (const CLI::Option* option : positionals_of(command))
    text += man_entry("\\fI" + roff(option->get_name(true)) + "\\fR", *option);
  for (const CLI::Option* option : options_of(command)) text += man_option(*option);
  if (!command.get_footer().empty()) text += ".PP\n" + roff(command.get_footer()) + "\n";
  return text;
}

struct Variable {
  const char* name;
  const char* what;
};

constexpr std::array environment = {
    Variable{"SPRINGPROOF_FEM_PROGRAM", "the finite element program, instead of springproof-fem beside springproof"},
    Variable{"SPRINGPROOF_MESH_PROGRAM", "the mesher, instead of springproof-mesh beside springproof"},
    Variable{"SPRINGPROOF_BENCH_PROGRAM", "the bench, instead of springproof-bench beside springproof"},
    Variable{"SPRINGPROOF_PROGRAM", "the springproof that the bench measures, instead of the one beside it"},
    Variable{"SPRINGPROOF_MESH_SECONDS", "time limit of the mesher [s] (default: 300)"},
    Variable{"SPRINGPROOF_MESH_CACHE",
             "folder in which meshes are kept between runs, up to 1 GB (default: $XDG_CACHE_HOME/springproof/meshes; "
             "empty: none are kept)"},
    Variable{"SPRINGPROOF_NO_SCRIPTS",
             "if set, .geo scripts other than the built-in ones are refused, as by --no-scripts"},
    Variable{"SPRINGPROOF_INSTRUCTION_SET",
             "portable, avx2 or avx512: what the kernels are to use (default: the widest of this processor)"},
    Variable{
        "SPRINGPROOF_DEVICE",
        "processor or gpu: where steps of lattices of whole cells are made (default: processor; gpu: in a build with "
        "SPRINGPROOF_CUDA, explicit steps without viscosity; equilibria are the processor's; not by the live "
        "page)"},
    Variable{"SPRINGPROOF_LAMMPS", "the lmp of LAMMPS that the bench measures beside ours, instead of the one on PATH"},
};

/// The variable of the script that holds the known values of an option or a positional argument.
std::string variable_of(const std::string& name) {
  return replaced(name.substr(name.find_first_not_of('-')), '-', "_");
}

/// The words of an option: its known values as a variable of the script; none: "".
std::string known_words(const CLI::Option& option, const KnownValues& values) {
  std::vector<std::string> names = spellings(option);
  names.push_back(option.get_name(true));
  for (const std::string& name : names)
    if (values.contains(name)) return "$" + variable_of(name);
  return "";
}

/// Branches `"COMMAND OPTION")` of the options that take a value: known ones, else file names.
std::string value_branches(const CLI::App& command, const KnownValues& values) {
  std::string text;
  for (const CLI::Option* option : options_of(command)) {
    if (!takes_value(*option)) continue;
    std::vector<std::string> patterns;
    for (const std::string& name : spellings(*option))
      patterns.push_back(fmt::format("\"{} {}\"", command.get_name(), name));
    const std::string words = known_words(*option, values);
    text += fmt::format("    {}) words=\"{}\" files={} ;;\n", fmt::join(patterns, " | "), words, words.empty() ? 1 : 0);
  }
  return text;
}

/// The branch `"COMMAND "*)`: its options, and the values of its positional arguments.
std::string command_branch(const CLI::App& command, const KnownValues& values) {
  std::vector<std::string> words;
  for (const CLI::Option* option : options_of(command))
    for (const std::string& name : spellings(*option)) words.push_back(name);
  const std::vector<const CLI::Option*> places = positionals_of(command);
  for (const CLI::Option* option : places) words.push_back(known_words(*option, values));
  return fmt::format("    \"{} \"*) words=\"{}\" files={} ;;\n", command.get_name(), fmt::join(words, " "),
                     places.empty() ? 0 : 1);
}

/// springproof.1 in roff, with every command and option that --help shows.
std::string man_page(const CLI::App& app, const std::string& version) {
  std::string text = fmt::format(".TH SPRINGPROOF 1 \"\" \"springproof {}\" \"User Commands\"\n", version);
  text += fmt::format(".SH NAME\nspringproof \\- {}\n", roff(app.get_description()));
  text += ".SH SYNOPSIS\n.B springproof\n.I COMMAND\n[\\fIOPTIONS\\fR]\n.SH OPTIONS\n";
  for (const CLI::Option* option : options_of(app)) text += man_option(*option);
  text += ".SH COMMANDS\n";
  for (const CLI::App* command : commands_of(app)) text += man_command(*command);
  text += ".SH ENVIRONMENT\n";
  for (const Variable& variable : environment)
    text += fmt::format(".TP\n\\fB{}\\fR\n{}\n", variable.name, roff(variable.what));
  return text;
}

/// A script for bash: commands, their options, known values, else file names.
std::string bash_completion(const CLI::App& app, const KnownValues& values) {
  std::vector<std::string> names;
  std::string known, branches, command_branches;
  for (const auto& [name, words] : values)
    known += fmt::format("  local {}=\"{}\"\n", variable_of(name), fmt::join(words, " "));
  for (const CLI::App* command : commands_of(app)) {
    names.push_back(command->get_name());
    branches += value_branches(*command, values);
    command_branches += command_branch(*command, values);
  }
  for (const CLI::Option* option : options_of(app))
    for (const std::string& name : spellings(*option)) names.push_back(name);
  return fmt::format(R"(# Completion of springproof for bash, written by `springproof describe bash`.
_springproof() {{
{}  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}} words="" files=0
  case "${{COMP_WORDS[1]}} $before" in
{}{}  esac
  [ "$COMP_CWORD" -gt 1 ] || {{ words="{}" files=0; }}
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word"; [ "$files" = 0 ] || compgen -f -- "$word")
}}
complete -o filenames -F _springproof springproof
)",
                     known, branches, command_branches, fmt::join(names, " "));
}

/// The last section of docs/keys.md.
std::string options_page() {
  std::string page =
      "\n## Options of models\n\nIn `models = [{ model = \"hybmss\", face_to_cube = 1 }]`; a model refuses what it "
      "does not have. Those on which moduli depend are options of `springproof material` and `homogenise` too.\n\n"
      "| option | what | value |\n|---|---|---|\n";
  for (const ModelOption& option : model_options()) {
    std::string value = option.allowed;  // "0 <= shift <= 1" is "0 to 1" beside the name
    const std::string between = fmt::format(" <= {} <= ", option.name);
    if (const auto at = value.find(between); at != std::string::npos) value.replace(at, between.size(), " to ");
    page += fmt::format("| `{}` | {} | {} |\n", option.name, option.what, value);
  }
  return page;
}

/// `springproof describe man|bash|keys`; not in --help.
class DescribeCommand {
 public:
  void add_options(CLI::App& command);
  int run() const;

 private:
  CLI::App* command_ = nullptr;
  std::string form_;
};

void DescribeCommand::add_options(CLI::App& command) {
  command.group("");
  command.add_option("FORM", form_)->required()->check(CLI::IsMember({"man", "bash", "keys"}));
  command_ = &command;
}

int DescribeCommand::run() const {
  if (form_ == "keys") {
    to_stdout("{}{}", keys_page(), options_page());
    return 0;
  }
  const CLI::App& app = *command_->get_parent();
  std::vector<std::string> cases, models, paper_names;
  for (const Paper& paper : papers()) paper_names.push_back(paper.name);
  for (const auto& file : built_in_cases()) cases.push_back(case_name(file));
  for (const ModelRow& row : model_table()) models.push_back(row.name);
  to_stdout("{}", form_ == "man"
                      ? man_page(app, SPRINGPROOF_VERSION)
                      : bash_completion(app, {{"CASE", cases}, {"--model", models}, {"PAPER", paper_names}}));
  return 0;
}

}  // namespace

RunCommand describe_command(CLI::App& parser) { return made<DescribeCommand>(parser); }

}  // namespace springproof
