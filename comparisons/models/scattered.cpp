#include "comparisons/models/external.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "msm/algebra/dense.h"

namespace springproof {
namespace {

double largest_extent(const NodalVectors& X) { return (X.colwise().maxCoeff() - X.colwise().minCoeff()).maxCoeff(); }

/// Edge of cells that hold about one point each.
double edge_for(const NodalVectors& X) {
  const double extent = largest_extent(X);
  return extent > 0 ? extent / std::max(1.0, std::cbrt(double(X.rows()))) : 1;
}

/// Value at p of the affine field fitted to the nodes; nothing if they span no volume.
std::optional<Vec3> affine_value(const NodalVectors& X, const NodalVectors& u, const std::vector<int>& nodes,
                                 const Vec3& p, double radius) {
  if (nodes.size() < 4) return {};
  const auto count = static_cast<Eigen::Index>(nodes.size());
  Eigen::MatrixXd basis(count, 4);
  Eigen::VectorXd bell(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Vec3 d = (X.row(nodes[i]).transpose() - p) / radius;
    basis.row(i) << 1, d.transpose();
    bell[i] = std::pow(std::max(0.0, 1 - d.squaredNorm()), 3) + 1e-9;
  }
  const Eigen::MatrixXd moments = basis.transpose() * bell.asDiagonal() * basis;
  const Eigen::VectorXd eigenvalues = symmetric_eigenvalues(moments);
  if (eigenvalues[0] < 1e-3 * eigenvalues[3]) return {};
  const Eigen::VectorXd weights = bell.cwiseProduct(basis * symmetric_solve(moments, Eigen::VectorXd::Unit(4, 0)));
  Vec3 value = Vec3::Zero();
  for (Eigen::Index i = 0; i < count; ++i) value += weights[i] * u.row(nodes[i]).transpose();
  return value;
}

}  // namespace

ScatteredField::ScatteredField(NodalVectors points, NodalVectors displacement)
    : X_(std::move(points)),
      u_(std::move(displacement)),
      edge_(edge_for(X_)),
      cells_(X_.colwise().minCoeff().transpose() - Vec3::Constant(1e-9 * edge_),
             X_.colwise().maxCoeff().transpose() + Vec3::Constant(1e-9 * edge_), edge_, false) {
  for (Eigen::Index n = 0; n < X_.rows(); ++n) cells_.add(X_.row(n).transpose());
  const double extent = largest_extent(X_), same = 1e-9 * extent;
  std::vector<double> distances;
  for (Eigen::Index n = 0; n < X_.rows() && extent > 0; ++n) {
    const Vec3 p = X_.row(n).transpose();
    double nearest = std::numeric_limits<double>::infinity();
    for (double radius = edge_; nearest > radius; radius *= 2)
      for (const int other : near(p, radius))
        if (const double d = (X_.row(other).transpose() - p).norm(); d > same) nearest = std::min(nearest, d);
    distances.push_back(nearest);
  }
  if (distances.empty()) return;
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  spacing_ = *middle;
}

std::vector<int> ScatteredField::near(const Vec3& p, double radius) const {
  std::vector<int> found;
  const double rings = std::min(radius / edge_, 1e6);
  cells_.any_near(
      p,
      [&](int n) {
        if ((X_.row(n).transpose() - p).norm() <= radius) found.push_back(n);
        return false;
      },
      static_cast<int>(rings) + 1);
  std::ranges::sort(found);
  return found;
}

double ScatteredField::distance(const Vec3& p) const {
  for (double radius = edge_;; radius *= 2) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const int n : near(p, radius)) nearest = std::min(nearest, (X_.row(n).transpose() - p).norm());
    if (std::isfinite(nearest) || !std::isfinite(radius)) return nearest;
  }
}

Vec3 ScatteredField::at(const Vec3& p) const {
  if (const std::vector<int> here = near(p, same_place()); !here.empty()) {
    Vec3 mean = Vec3::Zero();
    for (const int n : here) mean += u_.row(n).transpose() / double(here.size());
    return mean;
  }
  for (double radius = 1.6 * spacing_; radius <= 10 * spacing_; radius *= 1.2)
    if (const auto value = affine_value(X_, u_, near(p, radius), p, radius)) return *value;
  throw std::invalid_argument("the points span no volume");
}

}  // namespace springproof
