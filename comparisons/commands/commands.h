// The subcommands of springproof.
#pragma once

#include <functional>
#include <memory>
#include <string>

namespace CLI {
class App;
}

namespace springproof {

/// Runs a subcommand whose options have been read: its exit status.
/// @throws InputError if the input is unusable.
using RunCommand = std::function<int()>;

/// A subcommand that is a class with `add_options` and `run`.
template <class Command>
RunCommand made(CLI::App& parser) {
  const auto object = std::make_shared<Command>();
  object->add_options(parser);
  return [object] { return object->run(); };
}

// Each adds its options to the parser.
RunCommand advise_command(CLI::App& parser);
RunCommand bench_command(CLI::App& parser);
RunCommand compare_command(CLI::App& parser);
RunCommand cross_check_command(CLI::App& parser);
RunCommand describe_command(CLI::App& parser);
RunCommand diff_command(CLI::App& parser);
RunCommand export_command(CLI::App& parser);
RunCommand frequencies_command(CLI::App& parser);
RunCommand homogenise_command(CLI::App& parser);
RunCommand identify_command(CLI::App& parser);
RunCommand list_command(CLI::App& parser);
RunCommand material_command(CLI::App& parser);
RunCommand new_command(CLI::App& parser);
RunCommand pictures_command(CLI::App& parser);
RunCommand report_command(CLI::App& parser);
RunCommand reproduce_command(CLI::App& parser);

/// The output of `springproof --version`: "springproof 0.1.0", the libraries that it is built with, and a line for each
/// program beside it with the libraries of that one.
std::string versions();

}  // namespace springproof
