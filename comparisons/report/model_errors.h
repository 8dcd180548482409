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
  double error = -1;
  double uncertainty = 0;
  std::string case_name;
  std::string of = "displacement";  ///< "force on z_max"

  void take(double other, double its_uncertainty, const std::string& its_case,
            const std::string& its_of = "displacement") {
    if (other > error) *this = {other, its_uncertainty, its_case, its_of};
  }
};

using ByNu = std::map<double, Worst>;

/// Errors of one model.
struct ModelErrors {
  ByNu displacement, volume, reaction;
  ByNu springs;                         ///< displacement: the springs' own part of it, on bodies of voxels
  ByNu promised;                        ///< displacement: what cut cells estimate of themselves
  ByNu rank;                            ///< errors by which the closest model is found
  std::set<std::string> cases;          ///< in which a displacement or a reaction was compared
  std::optional<double> own_nu;         ///< the only Poisson's ratio that the model is valid for, if any
  bool blocks = false, voxels = false;  ///< bodies of which they are
  bool asked = false;                   ///< for displacements
  bool parts = false, wholes = false;   ///< ranked by the springs' own part somewhere, by the whole error somewhere
};

/// Models in the order in which they are listed.
struct ModelKey {
  bool large_deformation, beside;  ///< beside: elements or another program, not springs
  std::size_t order;               ///< of first appearance
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

/// The answer: which spring models come closest to finite elements; these are added to `closest`.  Empty: none was
/// compared.
std::string closest_at_rest(const std::map<ModelKey, ModelErrors>& models, std::vector<std::string>& closest);

/// Which of the models that were compared most widely comes closest to finite elements in time, by the probes'
/// difference over the whole motion; or nothing.  Where no model was named at rest, these are the `closest`.
std::string closest_in_time(const std::map<std::string, ByNu>& models, std::vector<std::string>& closest);

}  // namespace springproof
