// The subcommand that says what is built in.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace springproof {

/// `springproof list [models | measures | CASE...]`.
class ListCommand {
 public:
  void add_options(CLI::App& command);
  /// Without names all that is built in; "models", "measures"; of a folder its cases; of a case its file.
  int run() const;

 private:
  std::vector<std::string> names_;
};

}  // namespace springproof
