// The subcommand `springproof identify`.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace springproof {

/// `springproof identify CASE`.
class IdentifyCommand {
 public:
  void add_options(CLI::App& command);
  /// @return 0, or 1 if one has no result; 130 if interrupted.
  int run() const;

 private:
  std::string case_, out_ = "springproof-identify";
  std::vector<std::string> only_;
  std::vector<double> start_;
  int synthetic_ = 0;
  bool resume_ = false, json_ = false;
};

}  // namespace springproof
