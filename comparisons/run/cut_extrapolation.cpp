#include "comparisons/run/cut_extrapolation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "meshes/mesher/mesher.h"

namespace springproof {

std::vector<ExtrapolatedModel> extrapolate_cut_cells(const PreparedCase& prepared, const std::vector<CutState>& all) {
  const auto edge = [&](const CutState* s) { return prepared.lattices[s->lattice].error_scale(); };
  std::vector<ExtrapolatedModel> limits;
  for (std::size_t model = 0; model < prepared.models.size(); ++model) {
    std::vector<const CutState*> states;
    for (const CutState& s : all)
      if (s.model == model) states.push_back(&s);
    std::sort(states.begin(), states.end(), [&](const auto* a, const auto* b) { return edge(a) < edge(b); });
    if (states.size() < 2 || edge(states[1]) < least_ratio * edge(states[0])) continue;
    const CutState &fine = *states[0], &coarse = *states[1];
    const double h = edge(&fine), H = edge(&coarse), factor = h / (H - h);
    ExtrapolatedModel limit;
    limit.label = prepared.experiment.models[model].label + extrapolated_suffix;
    limit.lattice = fine.lattice;
    limit.from = prepared.lattices[fine.lattice].estimated > 0
                     ? fmt::format("from estimated errors of {:.3g} and {:.3g}", H, h)
                     : fmt::format("from edges of {:.4g} and {:.4g} m", H, h);
    const NodalVectors from_coarse =
        displacement_at(cells_of(prepared.lattices[coarse.lattice], prepared.models[model]), coarse.displacement,
                        prepared.lattices[fine.lattice].mesh->nodes);
    limit.field = fine.field + factor * (fine.field - from_coarse);
    for (const auto& [measure, value] : fine.scalars) {
      if (measure == "promised_error") continue;  // what the limit is in proportion to: 0
      const double step = factor * (value - coarse.scalars.at(measure));
      limit.scalars[measure] = value + step;
      limit.step[measure] = std::abs(step);
    }
    limits.push_back(std::move(limit));
  }
  return limits;
}

}  // namespace springproof
