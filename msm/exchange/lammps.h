// The springs of a network for LAMMPS: atom_style bond, bond_style harmonic, no pair style, SI units.
#pragma once

#include <string>

#include "msm/laws/laws.h"

namespace springproof {

/// Whether LAMMPS computes the model: its forces are those of springs alone.
bool suits_lammps(const MassSpringModel& model);

/// The data file: nodes at x [m], springs as bonds in the network's order.  LAMMPS' energy is K (r - r0)^2, so K is
/// half of the spring constant.  Masses [kg] are written by types of atoms, or, if there are more than 64 different
/// ones, per atom (lammps_input() has the fix for them).
std::string lammps_data(const Network& network, const NodalVectors& x, const Eigen::VectorXd& mass);

/// The input that reads the data file and integrates in steps of `time_step` [s], without a command that runs.
std::string lammps_input(const Network& network, const Eigen::VectorXd& mass, const std::string& data_file,
                         double time_step);

}  // namespace springproof
