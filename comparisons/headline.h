// The verdict in sentences, computed from the results: the head of the report and the last lines on the
// terminal.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace springproof {

struct ModelVerdict {
  std::string model;
  bool finite_elements = false;    ///< a FEM of the lattice's own resolution, shown for comparison
  bool large_deformation = false;  ///< cases with a finite-strain law; told apart from the linear ones
  std::string sentence;            ///< "displacement within 0.8 % of FEM for ν from −0.5 to 0.4 ..."
};

struct Headline {
  std::string answer;  ///< which spring model comes closest in the linear cases; empty: none was compared
  std::vector<ModelVerdict>
      models;  ///< springs first, then finite elements; linear cases before large deformation
  int held = 0, failed = 0, reference_too_coarse = 0, no_reference = 0, no_result = 0;  ///< expectations
  std::vector<std::string> failed_checks;  ///< one line each, with expected and computed value
  std::vector<std::string> failed_runs;    ///< one line each, with the reason
};

/// Judges each model by its largest "displacement_error" (and "volume_change" error) over the cases and
/// Poisson's ratios, at the finest resolution of each case.  `results` is the document of results.json.
Headline headline(const nlohmann::json& results);

/// "31 of 36 expectations hold, 2 fail, for 3 the reference is too coarse."
std::string expectations_sentence(const Headline& headline);

}  // namespace springproof
