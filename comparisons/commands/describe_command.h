// The subcommand that packages and shells ask for the command line.
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace springproof {

/// `springproof describe man|bash`; not in --help.
class DescribeCommand {
 public:
  void add_options(CLI::App& command);
  int run() const;

 private:
  CLI::App* command_ = nullptr;
  std::string form_;
};

}  // namespace springproof
