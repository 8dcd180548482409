// The stiffness of one cell of a lattice model: what the lattice's hierarchy and time step are made of.
#pragma once

#include "msm/laws/laws.h"

namespace springproof {

using CellMatrix = Eigen::Matrix<double, 24, 24>;
using CellVector = Eigen::Matrix<double, 24, 1>;

/// Rest stiffness of one cell [N/m], unknown 3 * corner + axis: its share of springs, and its own cell laws; momentum
/// dispersion, which reaches past the cell, is left out.
/// total = without_volume + (kappa / V) gradient gradient^T.
struct CellStiffness {
  CellMatrix total;
  CellMatrix without_volume;
  CellVector volume_gradient;  ///< dV'/dx at rest [m^2]
  double kappa = 0;            ///< [Pa]; 0 for models without volume correction
  double volume = 0;           ///< V [m^3]
};

/// Whether the rest stiffness of a model is the sum of its cells': a lattice, without what reaches past a cell.
bool consists_of_cells(const MassSpringModel& model);

/// The same with G, edge and G * edge as the units of pressure, length and stiffness: entries of order one.
CellStiffness in_units(CellStiffness cell, double shear_modulus, double edge);

/// @throws std::invalid_argument for a network without cells.
CellStiffness cell_stiffness(const MassSpringModel& model);

}  // namespace springproof
