// What measured values tell of the numbers of a case.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "comparisons/results/records.h"
#include "problem/case_file/identification.h"

namespace springproof {

/// A sought number; all in the unit of its key.
struct IdentifiedParameter {
  std::string name;
  std::vector<std::string> of;
  double start = 0, lower = 0, upper = 0;
  bool logarithmic = false;
  bool held = false;  ///< the values do not tell it: it stays at its start; the rest is what it would be if it were not
  double value = 0;
  double u_data = 0;                       ///< standard uncertainty by the fitted values
  std::optional<double> u_inputs = {};     ///< by the inputs whose runs have values; empty: it is held
  std::optional<double> u_numerical = {};  ///< by what is not known of the limit of the lattices; empty: one lattice
  double u = 0;                            ///< of all that is known
  double from = 0, to = 0;                 ///< limits of 95 %, within the bounds
  std::vector<InputShare> inputs = {};     ///< what each input changes it by
};

/// A measured value beside the fit.
struct IdentifiedValue {
  std::string name, load_case, unit;
  bool fitted = false;
  double measured = 0, u_measured = 0;
  std::optional<double> simulated = {};        ///< the limit of the lattices
  std::optional<double> residual = {};         ///< (simulated - measured) / u_measured
  std::optional<double> u_numerical = {};      ///< empty: one lattice
  std::optional<double> u_fit = {};            ///< of a prediction, by the fit's values
  std::optional<double> u_fit_numerical = {};  ///< by what is not known of their limits
  std::optional<double> u_input = {};          ///< by the inputs, of which the fit answers to a part
  std::optional<double> u_val = {};
  std::optional<double> ratio = {};  ///< |E| / u_val
};

/// Along which the parameters are known to a standard uncertainty of u, in logarithms where they are sought so.
struct KnownDirection {
  std::vector<double> along;
  double u = 0;
};

/// How often the limits of 95 %, by the data alone, held the parameters of synthetic sets.
struct SyntheticSets {
  int sets = 0;
  std::vector<int> inside;  ///< of each parameter that is not held
};

struct Identified {
  std::string case_name, name, model;
  std::vector<Cells> cells;
  bool ok = false;
  std::string message;  ///< why not
  int iterations = 0;
  std::vector<IdentifiedParameter> parameters;
  std::vector<std::vector<double>> correlation;  ///< of those that are found; of one that is held, were it not
  std::vector<KnownDirection> directions;        ///< the worst known first
  std::vector<IdentifiedValue> values;
  double chi2 = 0;
  int freedom = 0;    ///< fitted values less parameters that are not held
  std::string worst;  ///< the fitted value that is furthest off
  SyntheticSets synthetic;
  int runs = 0, kept = 0;  ///< made, and taken from what was kept before
  std::vector<std::string> sentences;
};

/// identify.json, without what is not finite.
std::string json_text(const std::vector<Identified>& all);

/// The same in words, for a terminal of 100 columns.
std::string text_of(const Identified& identified);

/// The same as a page of its own.
std::string identify_page(const std::vector<Identified>& all);

/// What the values do not tell, what the limits leave out, whether the values agree, and how many predictions hold.
std::vector<std::string> sentences_of(const Identified& identified);

/// Weighted least squares over the fitted values, by their uncertainties, on the lattice of fewest cells, corrected to
/// the limit of all its lattices until that no longer matters.  What the values do not tell is held at its start.  The
/// uncertainties are those of the values, of the case's inputs (but for what is sought) and of the limit.
/// @param folder where runs are kept
/// @param synthetic number of sets that are made of the fit and fitted anew
Identified identify(const Experiment& experiment, const Identification& sought, const std::filesystem::path& folder,
                    int synthetic);

}  // namespace springproof
