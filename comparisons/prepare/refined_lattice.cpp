#include "comparisons/prepare/refined_lattice.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "msm/statics/equilibrium.h"
#include "problem/processes/child.h"
#include "problem/system/progress.h"

namespace springproof {
namespace {

constexpr std::size_t most_cells = 100000;
constexpr double untold = 4;  // what an estimate is taken to fall short by as long as no other lattice tells

/// The energies of the lattice in each material of the case.
std::vector<CellEnergies> energies_of(const PreparedCase& prepared, const CutBody& cut, const Mesh& body) {
  const auto parameters =
      std::ranges::find_if(prepared.models, [](const ModelParameters& p) { return p.cut.value_or(false); });
  std::set<std::string> held;
  for (const Load& load : prepared.loads)
    if (prescribes_displacement(load)) held.insert(*patch_of(load));
  std::vector<CellEnergies> energies;
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
    energies.push_back(cell_energies(built.model, state.displacement));
  }
  return energies;
}

}  // namespace

Refinement::Refinement(const PreparedCase& prepared, VoxelGrid grid, const Mesh& body)
    : prepared_(prepared), grid_(std::move(grid)), body_(body), by_material_(prepared.experiment.materials.size()) {}

void Refinement::solve() {
  cut_ = cut_body(grid_, body_);
  estimated_ = 0;
  falls_short_ = 1;
  const std::vector<CellEnergies> energies = energies_of(prepared_, cut_, body_);
  for (std::size_t m = 0; m < energies.size(); ++m) {
    const double error = energies[m].estimated_error();
    by_material_[m].push_back({error, energies[m].elastic});
    falls_short_ = std::max(falls_short_, falls_short(by_material_[m]).value_or(untold));
    if (error > estimated_) errors_ = energies[m].larger();
    estimated_ = std::max(estimated_, error);
  }
}

RefinedBody Refinement::until(double accuracy) {
  if (errors_.empty()) solve();
  while (true) {
    const bool reached = falls_short_ * estimated_ <= accuracy;
    if (reached || cut_.cells.size() > most_cells || !halve_worst_cells(cut_, errors_, grid_))
      return {cut_, estimated_, falls_short_, reached};
    solve();
    progress::detail([&] {
      return fmt::format("refining for {:.3g} %: {} cells promise {:.3g} %", 100 * accuracy, cut_.cells.size(),
                         100 * falls_short_ * estimated_);
    });
  }
}

}  // namespace springproof
