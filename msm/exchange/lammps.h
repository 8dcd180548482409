// Springs for LAMMPS: bond_style harmonic, angle_style harmonic for angular springs, no pair style, SI units.
#pragma once

#include <string>

#include "msm/laws/laws.h"

namespace springproof {

/// The data file: nodes at x [m], springs as bonds in the network's order, the corners of triangles as angles if there
/// are angular springs.  LAMMPS' energies are K (r - r0)^2 and K (phi - phi0)^2, so K is half of the constant.  Masses
/// [kg] are written by types of atoms, or, if there are more than 64 different ones, per atom (lammps_input() has the
/// fix for them).
std::string lammps_data(const MassSpringModel& model, const NodalVectors& x, const Eigen::VectorXd& mass);

/// The input that reads the data file and integrates in steps of `time_step` [s], without a command that runs.
std::string lammps_input(const MassSpringModel& model, const Eigen::VectorXd& mass, const std::string& data_file,
                         double time_step);

}  // namespace springproof
