#include "comparisons/prepare/refined_lattice.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "msm/measure/promised_error.h"
#include "msm/statics/equilibrium.h"
#include "problem/processes/child.h"
#include "problem/system/progress.h"

namespace springproof {
namespace {

constexpr std::size_t most_cells = 100000;

/// The energies of the material whose promised error is the largest.
CellEnergies worst_energies(const PreparedCase& prepared, const CutBody& cut, const Mesh& body) {
  const auto parameters = std::find_if(prepared.models.begin(), prepared.models.end(),
                                       [](const ModelParameters& p) { return p.cut.value_or(false); });
  std::set<std::string> held;
  for (const Load& load : prepared.loads)
    if (prescribes_displacement(load)) held.insert(*patch_of(load));
  CellEnergies worst;
  for (const IsotropicMaterial& material : prepared.experiment.materials) {
    const EmbeddedModel built = build_cut(*parameters, cut, {held.begin(), held.end()}, body, material);
    BoundaryConditions conditions =
        transfer(prepared.loads, body, built.embedding, built.model.network, material.density, Kinematics::linear);
    if (parameters->hold_rigid_motions)
      hold_free_motions(built.model.network.X, conditions, built.model.network.cells.carried);
    require_supported(conditions, built.model.network.X);
    if (children_interrupted()) throw std::runtime_error("interrupted");
    const Equilibrium state = solve_linear(built.model, conditions);
    if (!state.ok) throw InputError(fmt::format("body.accuracy: {}", state.message));
    CellEnergies energies = cell_energies(built.model, state.displacement);
    if (worst.error.empty() || energies.promised_error() > worst.promised_error()) worst = std::move(energies);
  }
  return worst;
}

}  // namespace

RefinedBody refine_until(const PreparedCase& prepared, VoxelGrid grid, const Mesh& body, double accuracy) {
  while (true) {
    RefinedBody refined{cut_body(grid, body)};
    progress::detail(
        [&] { return fmt::format("refining for {:.3g} %: {} cells", 100 * accuracy, refined.cut.cells.size()); });
    const CellEnergies energies = worst_energies(prepared, refined.cut, body);
    refined.promised = energies.promised_error();
    refined.reached = refined.promised <= accuracy;
    if (refined.reached || refined.cut.cells.size() > most_cells ||
        !halve_worst_cells(refined.cut, energies.larger(), grid))
      return refined;
  }
}

}  // namespace springproof
