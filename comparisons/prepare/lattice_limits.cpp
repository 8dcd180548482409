#include "comparisons/prepare/lattice_limits.h"

#include <algorithm>
#include <cmath>

#include "msm/measure/validity.h"
#include "msm/topology/cubic_lattice.h"
#include "problem/case_file/external.h"

namespace springproof {
namespace {

constexpr double harmless_strain = 0.01;
constexpr double in_places = 1.25;  // a body is strained by so much more than on average
constexpr double near = 1e-9;       // of the body's size: supports that far apart impose no strain

/// Whether strain_limit() knows the model.
bool is_of_cells(const ModelParameters& p) {
  return p.row.topology == Topology::cells && !p.has(Extension::momentum_dispersion) && !p.cut.value_or(false);
}

std::optional<LatticeLimit> limit_of(const ModelParameters& p, const IsotropicMaterial& material, double strain) {
  const auto free = strain_limit(p, material, Sides::free, in_places * strain),
             held = strain_limit(p, material, Sides::held, in_places * strain);
  if (!free && !held) return {};
  LatticeLimit limit;
  limit.poisson_ratio = material.poisson_ratio;
  limit.imposed = strain;
  if (free) limit.free = free->strain;
  if (held) limit.held = held->strain;
  limit.wave = describe_wave(free ? free->k : held->k);
  return limit;
}

}  // namespace

ImposedStrain imposed_strain(const PreparedCase& prepared) {
  struct Support {
    Vec3 at;
    const PrescribedDisplacement* moved;
  };
  const Mesh& mesh = *prepared.lattices.front().mesh;
  std::vector<Support> supports;
  for (const Load& load : prepared.loads)
    if (const auto* moved = std::get_if<PrescribedDisplacement>(&load))
      supports.push_back({centroid(mesh, patch(mesh, moved->on)), moved});
  ImposedStrain imposed;
  for (const Support& a : supports)
    for (const Support& b : supports)
      for (int axis = 0; axis < 3; ++axis) {
        const auto from = a.moved->displacement[axis], to = b.moved->displacement[axis];
        const double apart = b.at[axis] - a.at[axis];
        if (!from || !to || apart < near * prepared.body.size.norm()) continue;
        imposed.compression = std::min(imposed.compression, (*to - *from) / apart);
        imposed.tension = std::max(imposed.tension, (*to - *from) / apart);
      }
  return imposed;
}

std::vector<LatticeLimit> lattice_limits(const PreparedCase& prepared) {
  const Experiment& e = prepared.experiment;
  std::vector<LatticeLimit> limits;
  if (e.model_kinematics() == Kinematics::linear || prepared.lattices.empty()) return limits;
  const auto of_boxes = [](const Lattice& l) { return l.mesh->grid && !has_cubes(*l.mesh->grid); };
  if (std::any_of(prepared.lattices.begin(), prepared.lattices.end(), of_boxes)) return limits;  // known of cubes
  const ImposedStrain imposed = imposed_strain(prepared);
  const ModelParameters recommended = resolve({"hybmss_avg", {}, "hybmss_avg", {}});
  for (std::size_t m = 0; m < prepared.models.size(); ++m) {
    if (is_external(e.models[m]) || !is_of_cells(prepared.models[m])) continue;
    for (const IsotropicMaterial& material : e.materials)
      for (const double strain : {std::max(imposed.compression, -0.75), imposed.tension}) {
        if (std::abs(strain) < harmless_strain) continue;
        auto limit = limit_of(prepared.models[m], material, strain);
        if (!limit) continue;
        limit->model = e.models[m].label;
        if (prepared.models[m].row.name != recommended.row.name && !limit_of(recommended, material, strain))
          limit->instead = recommended.row.name;
        limits.push_back(*limit);
      }
  }
  return limits;
}

}  // namespace springproof
