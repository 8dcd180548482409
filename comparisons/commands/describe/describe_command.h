// The subcommand that packages, shells and docs ask for the command line and the keys of case files.
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace springproof {

/// `springproof describe man|bash|keys`; not in --help.
class DescribeCommand {
 public:
  void add_options(CLI::App& command);
  int run() const;

 private:
  CLI::App* command_ = nullptr;
  std::string form_;
};

}  // namespace springproof
