// The verdict in sentences, computed from the results: the head of the report and the last lines on the
// terminal.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "comparisons/report/model_errors.h"
#include "comparisons/results/records.h"

namespace springproof {

/// A row of the verdict.
struct ModelVerdict {
  std::string model;
  bool beside = false;             ///< no spring model: shown for comparison
  bool large_deformation = false;  ///< cases with a finite-strain law; listed apart from the linear ones
  ModelErrors errors;
  std::string sentence;  ///< "displacement within 0.8 % of FEM for ν from −0.5 to 0.4 ..."
};

/// What to know of a case before its errors are believed.
struct Warning {
  std::size_t case_number = 0;  ///< among the results' cases
  std::string brief;            ///< "ear: rotations of 31° are too large for linear theory (up to 5°)"
  std::string advice;           ///< "divide the load by at least 6.2, or set ..."; empty: none

  std::string text() const { return advice.empty() ? brief : brief + "; " + advice; }
};

struct Headline {
  std::string answer;  ///< which spring model comes closest in the linear cases, or, where there are none, in those of
                       ///< large deformation; then which in time; where none was compared, up to which load each is
                       ///< stable, if some are not
  std::string no_linear_theory;      ///< that the answer's linear cases are beyond linear theory; follows the answer
  std::optional<Warning> doubt;      ///< that the reference does not converge or is uncertain by more than 5 %, of the
                                     ///< worst such case; follows the answer
  std::vector<std::string> closest;  ///< that model, or those that cannot be told apart
  std::vector<ModelVerdict> models;  ///< as they are ranked; what is beside them last; linear cases before others
  std::vector<std::string> deformations;  ///< per case the reference's largest principal strain and rotation at each nu
  std::vector<std::string> motions;       ///< period and amplitude, drift of energy and momentum; one line each
  std::vector<Warning> warnings;          ///< that linear theory does not apply, and lost equilibria
  std::vector<Warning> notes;             ///< on loads and laws of large strain
  std::vector<std::string> measured;      ///< of cases without reference: model, measure, value; one line each
  std::vector<std::string> verification;  ///< of cases without models: value, target, error, verdict; one line each
  int held = 0, failed = 0, reference_too_coarse = 0, no_reference = 0, no_result = 0;  ///< expectations
  std::vector<std::string> failed_checks;  ///< one line each, with expected and computed value
  std::vector<std::string> failed_runs;    ///< one line each, with the reason
  std::vector<std::string> failures;       ///< no reference, no run with a result, nothing compared: one line each
};

/// Titles of the two groups of models.
inline constexpr const char* linear_title =
    "Linear elasticity: largest error of displacement and reactions, against the true body";
inline constexpr const char* large_title =
    "Large deformation: largest error of displacement and reactions, beside a finite-strain law";

/// Judges each model by its largest "displacement_error" or "reaction_error" against the true body, over the cases and
/// the Poisson's ratios that it is valid for, at the finest resolution of each case; auxetic solids (nu < 0) are named
/// apart where others were run.  Models that differ by less than the reference's uncertainty are named together; the
/// only model of the cases is not called the closest.
Headline headline(const std::vector<CaseResult>& results);

/// "31 of 36 expectations hold, 2 fail, for 3 the reference is too coarse."
std::string expectations_sentence(const Headline& headline);

/// True if every expectation holds and every case was compared.
bool success(const Headline& headline);

/// For a terminal: the answer, a table of the models of at most 100 columns, the warnings; with every sentence on
/// request.
std::string terminal_text(const Headline& headline, bool verbose = false);

}  // namespace springproof
