// Properties of a force law that solvers, kernels and the time step use: a constant of each law, next to its forces.
//
// Beside its traits a law has a function `fields` that names its parameters, for springs files (msm/exchange/):
// number(KEY, value, least, largest), flag(KEY, value), choice(KEY, enumerator) with the enumerators' names_of(),
// of_springs(KEY, one or two numbers per spring), of_nodes(KEY, a node per node).
#pragma once

#include <cstddef>

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

/// Properties of a force law.
struct LawTraits {
  const char* name;              ///< "momentum dispersion"
  Reach reach;                   ///< which nodes the force at a node depends on
  bool lattice_kernels = false;  ///< implemented in msm/kernels/lattice_kernels.h; otherwise the plain loops are used
  bool list_kernels = false;     ///< implemented in msm/kernels/list_kernels.h; otherwise the plain loops are used
};

}  // namespace springproof
