#include "comparisons/commands/describe/describe_command.h"

#include <fmt/format.h>

#include "comparisons/commands/describe/describe.h"
#include "comparisons/reproduce/figures.h"
#include "comparisons/sweep/find_cases.h"
#include "msm/parameters/model_options.h"
#include "msm/parameters/model_table.h"
#include "problem/case_file/keys.h"
#include "problem/system/streams.h"

namespace springproof {
namespace {

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

}  // namespace

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

}  // namespace springproof
