// Properties of a force law that solvers, kernels and the time step use: a constant of each law, next to its forces.
//
// Beside its traits a law has a function `fields` that names its parameters, for springs files (msm/exchange/):
// number(KEY, value, least, largest), flag(KEY, value), choice(KEY, enumerator) with the enumerators' names_of(),
// of_springs(KEY, one or two numbers per spring), of_nodes(KEY, a node per node), of_cells(KEY, numbers per cell).
#pragma once

#include <array>
#include <cstddef>
#include <initializer_list>

namespace springproof {

/// The name of an enumerator in files: names_of(), which stands beside each such enum, has them in its order.
template <class Enum>
requires requires(Enum value) { names_of(value); }
constexpr const char* name_of(Enum value) { return names_of(value)[static_cast<std::size_t>(value)]; }

/// Which nodes the force at a node depends on.
enum class Reach {
  springs,            ///< those connected to it by springs; on a lattice of cells, part of the stiffness of a cell
  cells,              ///< those of its cells: one term per cell
  second_neighbours,  ///< also their neighbours: not part of a cell's stiffness
};

/// What kernels, solvers, integrators and files ask of a model: lacks() of it says why not (msm/laws/capabilities.h).
enum class Capability {
  lattice_kernels,      ///< compiled kernels of lattices of equal cells (msm/kernels/lattice_kernels.h)
  gpu,                  ///< the same on a GPU (msm/gpu/)
  cell_kernels,         ///< those of cells, full or cut (msm/kernels/cell_forces.h)
  list_kernels,         ///< those of springs of any network (msm/kernels/list_forces.h)
  list_stiffness,       ///< their stiffness at rest (msm/kernels/list_stiffness.h)
  cells_of_any_shape,   ///< acts in cells that are boxes, cut, or of several sizes
  cut_multigrid,        ///< multigrid of cut cells (msm/multigrid/cut/cut_multigrid.h)
  equal_cells,          ///< the stiffness at rest is the sum of that of equal cells of a grid
  nodal_pressures,      ///< volume terms at the nodes of a lattice as pressures (msm/multigrid/nodal_volumes.h)
  energy,               ///< forces derive from an energy, so that the tangent is symmetric
  large_displacements,  ///< forces turn with the body
  energy_momentum,      ///< forces over a step that keep energy and momenta (msm/dynamics/terms/energy_momentum.h)
  viscosity,            ///< dashpots (msm/dynamics/terms/viscosity.h)
  relaxation,           ///< branches that relax (msm/dynamics/terms/relaxing_cells.h)
  mass_average,         ///< a share of consistent mass (msm/dynamics/terms/mass_average.h)
  lammps,               ///< bonds and angles of LAMMPS
  recovered_stress,     ///< stress at the nodes, at small strain (msm/measure/promised_error.h)
};
constexpr std::array<const char*, 17> names_of(Capability) {
  return {"lattice kernels",
          "steps on a GPU",
          "cell kernels",
          "list kernels",
          "stiffness by lists",
          "cells that are boxes, cut or of several sizes",
          "multigrid of cut cells",
          "stiffness of equal cells",
          "nodal pressures",
          "energy",
          "large displacements",
          "energy-momentum steps",
          "viscosity",
          "relaxation",
          "consistent mass",
          "terms of LAMMPS",
          "recovered stress"};
}

/// A set of them.
class Capabilities {
 public:
  /// @param all of the set
  constexpr Capabilities(std::initializer_list<Capability> all) {
    for (const Capability c : all) bits_ |= 1u << static_cast<unsigned>(c);
  }
  /// @return whether it is one of them
  constexpr bool has(Capability c) const { return bits_ >> static_cast<unsigned>(c) & 1; }

 private:
  unsigned bits_ = 0;
};

/// What every law has unless its function `lacks` says no.
inline constexpr Capabilities of_any_law = {
    Capability::equal_cells, Capability::nodal_pressures, Capability::energy,      Capability::large_displacements,
    Capability::viscosity,   Capability::relaxation,      Capability::mass_average};

/// Properties of a force law.  What depends on its parameters a law refuses by a function `lacks(Capability)`: why,
/// with the law as its subject, or nullptr.
struct LawTraits {
  const char* name;       ///< "momentum dispersion"
  Reach reach;            ///< which nodes the force at a node depends on
  Capabilities can = {};  ///< beside of_any_law
};

}  // namespace springproof
