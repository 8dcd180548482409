// Means over the regions of a body of springs.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "msm/laws/laws.h"
#include "problem/loads.h"
#include "problem/region.h"

namespace springproof {

/// region.<region>.<quantity> of cells of averaged springs: volume_change by the mean deformation gradients;
/// displacement over the volume at rest; energy of the cells, without that of the bonds; mean_stress, pressure of
/// Cauchy's stress over the deformed volume: the first moments of the forces of the cells on their corners, or at small
/// strain Hooke's law of the mean strain.
/// @throws std::invalid_argument if the model has no averaged springs.
std::map<std::string, double> region_means(const MassSpringModel& model, const std::vector<MaterialRegion>& regions,
                                           const NodalVectors& u, Kinematics kinematics);

/// interface.<region>.<other>.force of the same cells: of the bonds between two materials and, where cells of both have
/// common corners, half of the difference of their forces there, those of gravity included; other loads on common
/// corners count half for each.
/// @param weight forces of gravity on the nodes [N], n x 3
/// @throws std::invalid_argument if the model has no averaged springs.
std::map<std::string, double> interface_forces(const MassSpringModel& model, const std::vector<MaterialRegion>& regions,
                                               const NodalVectors& u, const NodalVectors& weight,
                                               Kinematics kinematics);

}  // namespace springproof
