// Stiffness of one cell of a lattice model, for the lattice's multigrid hierarchy and time step.
#pragma once

#include "msm/laws/laws.h"

namespace springproof {

using CellMatrix = Eigen::Matrix<double, 24, 24>;
using CellVector = Eigen::Matrix<double, 24, 1>;

/// Rest stiffness of one cell [N/m], unknown 3 * corner + axis: its share of springs, and its own cell laws; momentum
/// dispersion, which couples beyond the cell, is excluded.
/// total = without_volume + (kappa / V) gradient gradient^T.
struct CellStiffness {
  CellMatrix total;
  CellMatrix without_volume;
  CellVector volume_gradient;  ///< dV'/dx at rest [m^2]
  double kappa = 0;            ///< lambda less that of springs, G [Pa]; 0 for models without volume term
  double volume = 0;           ///< V [m^3]
};

/// The same with G, edge and G * edge as the units of pressure, length and stiffness: entries of order one.
CellStiffness in_units(CellStiffness cell, double shear_modulus, double edge);

/// @throws std::invalid_argument for a network without cells.
CellStiffness cell_stiffness(const MassSpringModel& model);

/// One cell of a lattice in a homogeneous state, without momentum dispersion.
struct StrainedCell {
  CellMatrix tangent;      ///< [N/m], as CellStiffness::total
  Eigen::Matrix3d stress;  ///< force over area at rest [Pa], row: of the force, column: of the normal
};

/// The cell at x = F X.
/// @throws std::invalid_argument for a network without cells.
StrainedCell strained_cell(const MassSpringModel& model, const Eigen::Matrix3d& F);

}  // namespace springproof
