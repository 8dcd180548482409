#include "msm/laws/capabilities.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "msm/laws/anchors.h"

namespace springproof {
namespace {

constexpr const char* in_kernels = "its laws occur together as in no kernel";
constexpr const char* of_several = "its cells are of several materials";

bool each_law_once(const MassSpringModel& model) {
  std::vector<std::size_t> kinds;
  for (const ForceLaw& law : model.laws) kinds.push_back(law.index());
  std::sort(kinds.begin(), kinds.end());
  return std::adjacent_find(kinds.begin(), kinds.end()) == kinds.end();
}

/// Whether springs have positive stiffness and no tension at rest.
bool springs_at_rest(const Network& network) {
  return std::all_of(network.springs.begin(), network.springs.end(), [&](const Spring& s) {
    return s.stiffness > 0 &&
           std::abs((network.X.row(s.j) - network.X.row(s.i)).norm() - s.rest_length) <= 1e-9 * s.rest_length;
  });
}

/// Why the laws of a model cannot together, each of which can.
std::string together_lack(const MassSpringModel& model, Capability what) {
  using enum Capability;
  const bool averaged = law_of<AveragedSprings>(model) != nullptr, measured = law_of<MeasuredCells>(model) != nullptr,
             springs = law_of<Springs>(model) != nullptr, dispersion = law_of<MomentumDispersion>(model) != nullptr;
  switch (what) {
    case lattice_kernels:
    case gpu:
      return each_law_once(model) && !(averaged && model.laws.size() > 1) && (springs || !dispersion) ? "" : in_kernels;
    case cell_kernels:
      return each_law_once(model) && averaged != measured ? "" : in_kernels;
    case list_kernels:
    case list_stiffness:
      return each_law_once(model) && springs ? "" : in_kernels;
    case cut_multigrid:
      return averaged != measured ? "" : "it has no averaged springs or measured cells";
    case nodal_pressures:
      return dispersion ? "" : "it has no momentum dispersion";
    case viscosity:
      if (!model.network.cells.materials.empty() && !averaged && !consists_of<Springs>(model))
        return "its cells, which are not of averaged springs, are of several materials";
      return model.network.cells.empty() && !consists_of<Springs>(model)
                 ? "its network has no cells, and more than springs between nodes"
                 : "";
    default:
      return "";
  }
}

std::string mass_average_lacks(const Network& network) {
  if (!network.cells.materials.empty()) return of_several;
  if (network.cells.empty()) return "its network has no cells";
  if (network.cells.kind() == CellKind::sizes) return "its cells are of several sizes";
  if (std::any_of(network.anchors.begin(), network.anchors.end(), [](const Anchor& a) { return a.axes != 7; }))
    return "supports hold its cut cells along some axes only";
  return network.image_of.empty() ? "" : "its network is periodic";
}

}  // namespace

std::string lacks(const ForceLaw& law, Capability what) {
  const LawTraits& of = traits(law);
  const char* why = std::visit(
      [&](const auto& l) -> const char* {
        if constexpr (requires { l.lacks(what); }) return l.lacks(what);
        return nullptr;
      },
      law);
  if (why) return fmt::format("{} {}", of.name, why);
  return of.can.has(what) || of_any_law.has(what) ? "" : fmt::format("{}: no {}", of.name, name_of(what));
}

std::string lacks(const Network& network, Capability what) {
  using enum Capability;
  const CellSet& cells = network.cells;
  const bool periodic = !network.image_of.empty();
  switch (what) {
    case lattice_kernels:
    case gpu:
      if (!cells.materials.empty()) return of_several;
      if (periodic || !network.triangles.empty()) return "its network is periodic or planar";
      return cells.cut() || cells.kind() == CellKind::boxes ? "its cells are cut, or boxes" : "";
    case cell_kernels:
      if (std::any_of(network.bonds.begin(), network.bonds.end(), turns)) return "its bonds turn with their cells";
      return !cells.empty() && !periodic ? "" : "its network has no cells, or is periodic";
    case list_stiffness:
      return springs_at_rest(network) ? "" : "its springs have tension at rest";
    case equal_cells:
      if (!cells.materials.empty()) return of_several;
      return cells.grid ? "" : "its network is no lattice of equal cells";
    case cut_multigrid:
      if (cells.kind() == CellKind::cubes && !cells.materials.empty() && !periodic) return "";
      return cells.cut() ? "" : "its cells are not cut, or cubes of several materials";
    case nodal_pressures:
      return cells.grid && !periodic ? "" : "its network is no lattice of equal cells, or is periodic";
    case relaxation:
      if (!network.image_of.empty()) return "its network is periodic";
      if (!cells.materials.empty()) return of_several;
      return cells.empty() ? "its network has no cells" : "";
    case mass_average:
      return mass_average_lacks(network);
    case lammps:
      return periodic ? "its network is periodic" : "";
    default:
      return "";
  }
}

std::string lacks(const MassSpringModel& model, Capability what) {
  for (const ForceLaw& law : model.laws)
    if (std::string why = lacks(law, what); !why.empty()) return why;
  if (std::string why = together_lack(model, what); !why.empty()) return why;
  return lacks(model.network, what);
}

}  // namespace springproof
