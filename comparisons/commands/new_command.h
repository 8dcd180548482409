// The subcommand that writes a case of a body.
#pragma once

#include <string>
#include <vector>

#include "problem/material.h"

namespace CLI {
class App;
}

namespace springproof {

/// `springproof new BODY > case.toml`.
class NewCommand {
 public:
  void add_options(CLI::App& command);
  /// Prints the case.  @return 0.
  /// @throws InputError if the file is no body, or the moduli cannot be used.
  int run() const;

 private:
  std::string body_;
  double scale_ = 1;
  std::vector<double> size_;
  Moduli moduli_;
  double density_ = 1000;
};

}  // namespace springproof
