// The subcommand that computes a spring model's parameters from any two moduli.
#pragma once

#include <string>

#include "msm/parameters/model_table.h"
#include "problem/case_file/experiment.h"

namespace CLI {
class App;
}

namespace springproof {

class MaterialCommand {
 public:
  void add_options(CLI::App& command);

  /// Prints the table (or JSON).  @return 0.
  /// @throws InputError if the moduli or the model cannot be used.
  int run() const;

 private:
  Moduli moduli_;
  double density_ = 1000;
  double cell_size_ = 0.1, frequency_ = 1;
  ModelChoice choice_{recommended_model().name, {}, recommended_model().name, {}};
  bool json_ = false;
};

}  // namespace springproof
