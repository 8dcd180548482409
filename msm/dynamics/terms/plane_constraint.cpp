#include "msm/dynamics/terms/plane_constraint.h"

#include <algorithm>
#include <limits>

namespace springproof {
namespace {

constexpr double round_off = 1e-9;  // of distances relative to the spacing of the nodes, of reactions to the forces
constexpr double layer = 0.5;       // nodes that touch together, relative to the spacing
constexpr double stiffening = 1e6;

}  // namespace

PlaneConstraint::PlaneConstraint(const Plane& plane, Eigen::Index nodes, double spacing)
    : plane_(plane), spacing_(spacing), is_held_(nodes, 0) {}

void PlaneConstraint::put(NodalVectors& x) const {
  for (const int n : held_) x.row(n) -= plane_.distance(x.row(n).transpose()) * plane_.normal.transpose();
}

void PlaneConstraint::project(NodalVectors& v) const {
  for (const int n : held_) v.row(n) -= plane_.normal.dot(Vec3(v.row(n).transpose())) * plane_.normal.transpose();
}

void PlaneConstraint::stiffen(BlockMatrix& K) const {
  for (const int n : held_) K.add(n, n, stiffening * K.at(n, n).trace() * plane_.normal * plane_.normal.transpose());
}

bool PlaneConstraint::revise(const NodalVectors& x0, const NodalVectors& x1, const NodalVectors& unbalanced,
                             double scale, const std::vector<char>& fixed) {
  const auto free = [&](Eigen::Index n) { return !fixed[3 * n] && !fixed[3 * n + 1] && !fixed[3 * n + 2]; };
  const auto distance = [&](const NodalVectors& x, Eigen::Index n) { return plane_.distance(x.row(n).transpose()); };
  const auto pulls = [&](Eigen::Index n) {
    return plane_.normal.dot(Vec3(unbalanced.row(n).transpose())) > round_off * scale;
  };
  const auto is_behind = [&](Eigen::Index n) {
    return !is_held_[n] && free(n) && distance(x1, n) < -round_off * spacing_;
  };
  // Of those behind it the plane holds the layer next to it, which may hold back the others.
  double nearest = std::numeric_limits<double>::infinity();
  for (Eigen::Index n = 0; n < x1.rows(); ++n)
    if (is_behind(n)) nearest = std::min(nearest, distance(x0, n));
  std::vector<char> held(is_held_.size(), 0);
  for (Eigen::Index n = 0; n < x1.rows(); ++n)
    held[n] = is_held_[n] ? free(n) && !pulls(n) : is_behind(n) && distance(x0, n) <= nearest + layer * spacing_;
  if (held == is_held_) return false;
  is_held_ = std::move(held);
  held_.clear();
  for (std::size_t n = 0; n < is_held_.size(); ++n)
    if (is_held_[n]) held_.push_back(static_cast<int>(n));
  return true;
}

}  // namespace springproof
