// The same springs in LAMMPS (lmp on PATH): atom_style bond, bond_style harmonic, no pair style, lists never rebuilt.
#pragma once

#include <string>

#include "msm/topology/network.h"
#include "problem/processes/child.h"

namespace springproof::bench {

class Lammps {
 public:
  /// lmp on PATH, or what SPRINGPROOF_LAMMPS names.
  static bool available();

  /// Writes the data file: springs in the network's order (by first node), positions moved().  Nodes of more than 64
  /// different masses all get the mean one, since LAMMPS has masses per type.
  explicit Lammps(const Network& network);

  /// CPU time of one step [s]: the difference between a run of many steps and a run of one, over the number of steps,
  /// each the least of `runs` runs.  The steps take about `seconds_of_steps`, or as long as reading the data, whichever
  /// is longer.
  /// @throws std::runtime_error if LAMMPS fails, with its error message.
  double seconds_per_step(double seconds_of_steps, int runs) const;

  /// LAMMPS' forces at the positions moved() [N].
  NodalVectors forces() const;

 private:
  double seconds_of(const std::string& commands) const;  ///< CPU time of the whole process

  TemporaryFolder folder_;
  std::string set_up_;  ///< the commands before those that run
  long nodes_, springs_;
};

}  // namespace springproof::bench
