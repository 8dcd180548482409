// Moments of the part of a cube that a body fills.
#pragma once

#include "problem/vector.h"

namespace springproof {

/// Ten moments; `<.>` is the mean over the filled part, xi = (X - centre of the cube) / edge in [-1/2, 1/2]^3.
struct FilledPart {
  double fraction = 1;                       ///< alpha, of the cube's volume
  Vec3 mean = Vec3::Zero();                  ///< c = `<xi>`
  Vec3 mixed = Vec3::Zero();                 ///< p = `<xi_y xi_z>`, `<xi_z xi_x>`, `<xi_x xi_y>`
  Vec3 variance = Vec3::Constant(1.0 / 12);  ///< S_i = `<xi_i^2>` - c_i^2
};

/// From the integrals of 1, xi and xi xi^T.
FilledPart filled_part(double volume, const Vec3& first, const Eigen::Matrix3d& second);

/// `<xi xi^T>`
Eigen::Matrix3d second_moments(const FilledPart& part);

}  // namespace springproof
