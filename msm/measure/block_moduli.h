// Young's modulus and Poisson's ratio of a stretched block, as the papers measure them.
#pragma once

#include "msm/measure/local_fields.h"

namespace springproof {

/// A block [lower, upper] stretched along x.
struct StretchedBlock {
  Vec3 lower;         ///< lowest corner [m]
  Vec3 upper;         ///< highest corner [m]
  double elongation;  ///< relative displacement of its ends [m]
};

/// What is measured of it.
struct BlockModuli {
  double force;                    ///< momentum flow through the middle plane [N]
  double youngs_modulus_nominal;   ///< (F/A) / (elongation / L_x) [Pa]; Kot et al. (2014), sec. 5.1.  Too high if grips
                                   ///< shorten the length
  double youngs_modulus_local;     ///< (F/A) / (mean strain of the central region) [Pa]
  double poisson_ratio;            ///< by regression of the displacements in the central region [1]
  double poisson_ratio_of_fields;  ///< mean of eq. (29), corrected, over points of the central region
  double poisson_ratio_as_printed;  ///< the same by (29) as printed
};

/// Linear measures in the middle 80 % of the block along every axis.  `radius` [m]: of the local strain and stress, at
/// 7 x 3 x 3 points of that region whose balls lie inside the block.
/// @throws std::invalid_argument if the central region or a ball holds too few nodes for a gradient.
BlockModuli measure_block(const MassSpringModel& model, const NodalVectors& u, const StretchedBlock& block,
                          double radius);

}  // namespace springproof
