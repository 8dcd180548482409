// The symmetric form of a cell that gives the forces of its states best.
#pragma once

#include "msm/laws/measured_cells.h"

namespace springproof {

/// What holds the form near to that of averaged springs where the states say little.
struct FitSettings {
  double ridge = 0.1;       ///< weight of the metric, in units of the mean square of a deformation of the states
  double least = 0.02;      ///< eigenvalues of the form in the metric ...
  double largest = 3;       ///< ... are clipped to these
  bool of_scalars = false;  ///< in the metric strains and patterns are scaled to the states' forces, each by a number
};

/// Least squares: minimises sum |L^T C L y - s|^2 in the metric L L^T of `averaged` over symmetric C, with a ridge
/// about C = 1, and clips the eigenvalues of C.
/// @param averaged form of the cell, positive definite [N/m]
/// @param y deformations of the states, one per column [m]
/// @param s stresses of the states [N]
/// @param settings of the fit
/// @return L C L^T [N/m]
DeformationForm fit_form(const DeformationForm& averaged, const Eigen::MatrixXd& y, const Eigen::MatrixXd& s,
                         const FitSettings& settings = {});

}  // namespace springproof
