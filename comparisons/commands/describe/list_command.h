// The subcommand that says what is built in.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace springproof {

/// `springproof list [CASE...]`.
class ListCommand {
 public:
  void add_options(CLI::App& command);
  /// Without names all that is built in, else the files of these cases.
  int run() const;

 private:
  std::vector<std::string> names_;
};

}  // namespace springproof
