#include "msm/fracture/cracks.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "meshes/united_numbers.h"
#include "msm/topology/point_cells.h"

namespace springproof {
namespace {

double length_sum(const Network& network) {
  double sum = 0;
  for (const Spring& s : network.springs) sum += s.rest_length;
  return sum;
}

double mid_height(const Network& network) { return (network.X.col(2).minCoeff() + network.X.col(2).maxCoeff()) / 2; }

/// Middles of the broken springs of the upper half, moved into the plane z = 0.
std::vector<Vec3> crack_points(const Network& network, const std::vector<char>& broken) {
  const double half = mid_height(network);
  std::vector<Vec3> points;
  for (std::size_t s = 0; s < broken.size(); ++s) {
    if (!broken[s]) continue;
    const Vec3 at = (network.X.row(network.springs[s].i) + network.X.row(network.springs[s].j)).transpose() / 2;
    if (at.z() > half) points.emplace_back(at.x(), at.y(), 0);
  }
  return points;
}

/// exp(2 i phi) of the longer principal axis of points in the plane, times (l1 - l2)/(l1 + l2).
std::complex<double> principal_axis(const std::vector<Vec3>& points) {
  Vec3 mean = Vec3::Zero();
  for (const Vec3& p : points) mean += p / double(points.size());
  double xx = 0, xy = 0, yy = 0;
  for (const Vec3& p : points) {
    const Vec3 d = p - mean;
    xx += d.x() * d.x();
    xy += d.x() * d.y();
    yy += d.y() * d.y();
  }
  // The deviator of the covariance: (l1 - l2) (cos 2 phi, sin 2 phi) / 2.
  return xx + yy > 0 ? std::complex<double>(xx - yy, 2 * xy) / (xx + yy) : 0.0;
}

}  // namespace

CrackDirections crack_directions(const Network& network, const std::vector<char>& broken) {
  constexpr double radius_lengths = 2;
  constexpr std::size_t fewest_points = 4;
  const double radius = radius_lengths * length_sum(network) / double(network.springs.size());
  const std::vector<Vec3> points = crack_points(network, broken);
  const Vec3 low = network.X.colwise().minCoeff().transpose(), high = network.X.colwise().maxCoeff().transpose();
  PointCells cells({low.x(), low.y(), 0}, {high.x(), high.y(), radius}, radius, false);
  for (const Vec3& p : points) cells.add(p);
  CrackDirections result;
  std::complex<double> fourfold = 0, eightfold = 0;
  double weights = 0;
  for (const Vec3& p : points) {
    std::vector<Vec3> near;
    cells.for_near(p, 1, [&](int other) {
      if ((points[other] - p).norm() <= radius) near.push_back(points[other]);
    });
    if (near.size() < fewest_points) continue;
    ++result.springs;
    const std::complex<double> axis = principal_axis(near);
    const double weight = std::norm(axis);
    if (weight == 0) continue;
    weights += weight;
    fourfold += axis * axis;
    eightfold += axis * axis * axis * axis / weight;
    const double phi = std::fmod(std::arg(axis) / 2 + std::numbers::pi, std::numbers::pi);
    result.share[std::min(direction_bins - 1, static_cast<int>(phi / std::numbers::pi * direction_bins))] += weight;
  }
  if (weights == 0) return result;
  result.along_4 = fourfold.real() / weights;
  result.along_8 = eightfold.real() / weights;
  result.order_4 = std::abs(fourfold) / weights;
  result.order_8 = std::abs(eightfold) / weights;
  for (double& share : result.share) share /= weights;
  return result;
}

double crack_area(const Network& network, const std::vector<char>& broken) {
  const auto count = static_cast<double>(std::count_if(broken.begin(), broken.end(), [](char b) { return b != 0; }));
  return 2 * network.volume.sum() * count / length_sum(network);
}

int fragments(const Network& network, const Eigen::VectorXd& u, const std::vector<double>& shrinkage, double opening) {
  constexpr double smallest_share = 0.01;
  constexpr double depth_spacings = 0.75;
  const double spacing = std::cbrt(network.volume.sum() / network.nodes()),
               layer = network.X.col(2).maxCoeff() - depth_spacings * spacing;
  UnitedNumbers fragment(static_cast<std::size_t>(network.nodes()));
  const auto on_top = [&](int n) { return network.X(n, 2) > layer; };
  for (std::size_t n = 0; n < network.springs.size(); ++n) {
    const Spring& s = network.springs[n];
    if (!on_top(s.i) || !on_top(s.j)) continue;
    const Vec3 apart = u.segment<3>(3 * s.j) - u.segment<3>(3 * s.i) +
                       shrinkage[n] * (network.X.row(s.j) - network.X.row(s.i)).transpose();
    if (apart.norm() <= opening * s.rest_length) fragment.unite(s.i, s.j);
  }
  std::vector<int> size(network.nodes(), 0);
  int all = 0;
  for (int n = 0; n < network.nodes(); ++n)
    if (on_top(n)) ++size[fragment.of(n)], ++all;
  return static_cast<int>(
      std::count_if(size.begin(), size.end(), [&](int n) { return n > 0 && n >= smallest_share * all; }));
}

}  // namespace springproof
