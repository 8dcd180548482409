#include "msm/embedding/rigid_motions.h"

#include <Eigen/Geometry>

#include "msm/algebra/dense.h"

namespace springproof {
namespace {

constexpr double least_hold = 1e-10;  // of a mean square displacement of one

}  // namespace

RigidMotions::Values RigidMotions::at(int unknown) const {
  const Vec3 r = (X.row(unknown / 3).transpose() - middle) / size;
  Values value = Values::Zero();
  value[unknown % 3] = 1;
  for (int axis = 0; axis < 3; ++axis) value[3 + axis] = Vec3::Unit(axis).cross(r)[unknown % 3];
  return value;
}

Eigen::Matrix<double, 6, Eigen::Dynamic> free_motions(const std::vector<char>& fixed, const RigidMotions& rigid) {
  Eigen::Matrix<double, 6, 6> gram = Eigen::Matrix<double, 6, 6>::Zero();
  double count = 0;
  for (int i = 0; i < static_cast<int>(fixed.size()); ++i)
    if (fixed[i]) {
      gram += rigid.at(i) * rigid.at(i).transpose();
      ++count;
    }
  const Eigenpairs eigen = symmetric_eigenpairs(gram);  // ascending
  int free = 0;
  while (free < 6 && !(count > 0 && eigen.values[free] > least_hold * count)) ++free;
  return eigen.vectors.leftCols(free);
}

}  // namespace springproof
