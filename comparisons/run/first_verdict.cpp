#include "comparisons/run/first_verdict.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "comparisons/judge/judge.h"
#include "comparisons/run/model_samples.h"

namespace springproof {

std::string first_verdict(const PartRun& run, const NodalVectors& coarsest) {
  const std::size_t lattice = finest_lattice(run.prepared);
  const Experiment& e = run.experiment();
  if (e.fracture || !small_enough(e, run.mesh(lattice))) return {};
  const NodalVectors u = at_nodes(run.prepared.lattices[lattice], coarsest);
  const Eigen::VectorXd volumes = nodal_volumes(run.mesh(lattice));
  const double scale = scale_of_errors(run.prepared, run.prepared.lattices[lattice], u).mean;
  std::vector<std::pair<double, std::string>> errors;
  for (std::size_t m = 0; m < run.prepared.models.size(); ++m) {
    if (e.models[m].in_motion) continue;
    const std::vector<ModelSample> samples = samples_of(run, lattice, {m});  // none of a file of other cells or ratios
    if (samples.empty() || !samples.front().state.ok) continue;
    const NodalVectors difference = samples.front().field.displacement - u;
    errors.emplace_back(weighted_norm(difference, volumes) / scale, e.models[m].label);
  }
  if (errors.empty()) return {};
  std::sort(errors.begin(), errors.end());
  constexpr std::size_t most_named = 4;
  std::vector<std::string> words;
  for (std::size_t i = 0; i < std::min(most_named, errors.size()); ++i)
    words.push_back(fmt::format("{} {:.2g} %", errors[i].second, 100 * errors[i].first));
  if (errors.size() > most_named)
    words.push_back(fmt::format("{} more up to {:.2g} %", errors.size() - most_named, 100 * errors.back().first));
  return fmt::format("beside the coarsest grid alone: {}", fmt::join(words, ", "));
}

}  // namespace springproof
