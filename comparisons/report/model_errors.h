// Errors of the models over the cases, by which they are judged and ranked.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace springproof {

/// The largest error at one Poisson's ratio, over the cases.
struct Worst {
  double error = -1;       ///< against the true body, coarse cells and their shape included [1]
  double uncertainty = 0;  ///< of the reference [1]
  double place = 0;        ///< of whole cubes: what 8-node elements in them are off, by luck of where they lie [1]
  std::string case_name;
  std::string of = "displacement";  ///< "displacement", or a reaction, "force on z_max"

  void take(const Worst& other) {
    if (other.error > error) *this = other;
  }
};

using ByNu = std::map<double, Worst>;

/// Errors of one model.
struct ModelErrors {
  ByNu displacement, volume, reaction;
  ByNu promised;                        ///< displacement: what cut cells estimate of themselves
  ByNu rank;                            ///< the larger of displacement and reaction: the one number of the model
  std::set<std::string> cases;          ///< in which a displacement or a reaction was compared
  std::set<std::size_t> cells;          ///< numbers of cells of its finest lattices in them
  std::vector<double> seconds;          ///< CPU time of its solutions on these
  std::optional<double> own_nu;         ///< the only Poisson's ratio that the model is valid for, if any
  bool blocks = false, voxels = false;  ///< bodies of which they are
  bool asked = false;                   ///< for displacements
};

/// Models in the order in which they are listed.
struct ModelKey {
  bool large_deformation;
  bool beside;        ///< no spring model: elements, a limit of two lattices, another program shown for comparison
  std::size_t order;  ///< of first appearance
  std::string name;
  auto operator<=>(const ModelKey&) const = default;
};

/// "for ν from 0 to 0.4", "at ν = 0.3".
std::string range_text(double from, double to);
std::string range_text(const ByNu& errors);

/// The Poisson's ratio of the largest error, and that error; of one at least.
const std::pair<const double, Worst>& largest(const ByNu& errors);

/// The errors at the Poisson's ratios that the model is valid for.
ByNu claimed(const ModelErrors& errors, const ByNu& by_nu);

/// Those of them by which models are ranked: without the auxetic ones, where there are others.
ByNu ranked(const ModelErrors& errors, const ByNu& by_nu);

/// "800", "500 to 1,000": numbers of cells; empty: unknown.
std::string cells_range(const ModelErrors& errors);

/// Models as they are ranked: those compared most widely first, then by their largest error.
bool ranks_before(const ModelErrors& a, const ModelErrors& b);

/// The answer: which spring models come closest to finite elements, or how close the only one comes; the closest are
/// added to `closest`.  Empty: none was compared.
std::string closest_at_rest(const std::map<ModelKey, ModelErrors>& models, std::vector<std::string>& closest);

/// Which of the models that were compared most widely comes closest to finite elements in time, by the probes'
/// difference over the whole motion; or nothing.  Where no model was named at rest, these are the `closest`.
std::string closest_in_time(const std::map<std::string, ByNu>& models, std::vector<std::string>& closest);

}  // namespace springproof
