// Runs ccx on a deck and reads its results.
#pragma once

#include <filesystem>
#include <istream>
#include <string>
#include <vector>

#include "comparisons/calculix/deck.h"
#include "meshes/field.h"

namespace springproof::calculix {

/// ccx on PATH; empty: there is none.
std::filesystem::path program();

/// "This is Version 2.20" -> "2.20"; empty without ccx.
std::string version();

/// Printed numbers have seven digits: half a unit of the last one, relative.
inline constexpr double print_rounding = 5e-7;

/// Printed values of the last block per kind and node set.
struct Printed {
  NodalVectors displacement;  ///< of all nodes [m]
  NodalVectors force;         ///< RF of the constrained nodes, zero elsewhere [N]
  double time = 0;            ///< of the displacements
};

/// Reads a .dat file of a deck with `nodes` nodes.
/// @throws std::runtime_error if a node's values are missing.
Printed read_dat(std::istream& in, Eigen::Index nodes);

/// Frequencies [Hz] in a .dat file of a deck with modes, ascending.
std::vector<double> read_frequencies(std::istream& in);

/// Displacements of the probes [m] in a .dat file of a deck that moves, by time.
std::vector<std::pair<double, NodalVectors>> read_path(std::istream& in, const NodalWeights& at_probes);

/// Error bounds of a solution due to printing with seven digits.
struct PrintFloor {
  double force = 0;         ///< of a patch [N]
  double torque = 0;        ///< [N m]
  double displacement = 0;  ///< [m]
  double volume = 0;        ///< of a volume change [1]
};

struct Solution {
  bool ok = false;
  std::string message;              ///< reason of failure: ccx' own message
  NodalVectors displacement;        ///< of all nodes of the deck [m]
  Field field;                      ///< on the mesh with corner nodes only
  std::vector<double> frequencies;  ///< of DeckTask::modes, instead of all this [Hz]
  std::vector<double> time;         ///< of DeckTask::steps, instead of all this: 0 and the ends of the steps [s]
  std::vector<NodalVectors> path;   ///< displacements of the probes at these times [m]
  PrintFloor floor;
  double seconds = 0;  ///< CPU time of ccx
};

/// Solves the deck in a temporary folder, which is removed.  A run that fails or takes longer than
/// `time_limit` [s, wall time] has ok = false.
/// @throws std::runtime_error if ccx cannot be started.
Solution solve(const Deck& deck, double time_limit);

}  // namespace springproof::calculix
