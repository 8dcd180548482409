#include "msm/topology/ray_parity.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

namespace springproof {
namespace {

constexpr int cells_along_longest = 48;

enum : char { outside_cell, inside_cell, surface_cell };

int cell_along(const RayParity& s, int axis, double x) {
  const double step = std::floor((x - s.lower[axis]) / s.edge[axis]);
  return static_cast<int>(std::clamp(step, 0.0, s.count[axis] - 1.0));
}

std::pair<Vec3, Vec3> box_of(const RayParity& s, const std::array<int, 3>& t) {
  const Vec3 &a = s.points[t[0]], &b = s.points[t[1]], &c = s.points[t[2]];
  const Vec3 margin = Vec3::Constant(s.tolerance);
  return {a.cwiseMin(b).cwiseMin(c) - margin, a.cwiseMax(b).cwiseMax(c) + margin};
}

/// Whether the projected edge runs past p on the side of larger x.  The edge is taken from its lower point number to
/// the higher, so that both of its triangles get the same result to the last bit and parities are consistent.
bool edge_to_the_right(const RayParity& s, int i, int j, const Vec3& p) {
  if (i > j) std::swap(i, j);
  const Vec3 &a = s.points[i], &b = s.points[j];
  if ((a.y() <= p.y()) == (b.y() <= p.y())) return false;
  return a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()) > p.x();
}

bool line_meets(const RayParity& s, const std::array<int, 3>& t, const Vec3& p) {
  return edge_to_the_right(s, t[0], t[1], p) ^ edge_to_the_right(s, t[1], t[2], p) ^
         edge_to_the_right(s, t[2], t[0], p);
}

bool is_above(const RayParity& s, const std::array<int, 3>& t, const Vec3& p) {
  const Vec3& a = s.points[t[0]];
  const Vec3 normal = (s.points[t[1]] - a).cross(s.points[t[2]] - a);
  if (normal.z() == 0) return a.z() > p.z();
  return a.z() - (normal.x() * (p.x() - a.x()) + normal.y() * (p.y() - a.y())) / normal.z() > p.z();
}

bool on_triangle(const RayParity& s, const std::array<int, 3>& t, const Vec3& p) {
  const auto [low, high] = box_of(s, t);
  if ((p.array() < low.array()).any() || (p.array() > high.array()).any()) return false;
  return (closest_point(p, s.points[t[0]], s.points[t[1]], s.points[t[2]]) - p).norm() <= s.tolerance;
}

bool inside_by_ray(const RayParity& s, const Vec3& p) {
  const int column = cell_along(s, 1, p.y()) * s.count[0] + cell_along(s, 0, p.x());
  bool inside = false;
  for (int n = s.bucket_start[column]; n < s.bucket_start[column + 1]; ++n) {
    const auto& t = s.triangles[s.bucket_items[n]];
    if (on_triangle(s, t, p)) return true;
    if (line_meets(s, t, p) && is_above(s, t, p)) inside = !inside;
  }
  return inside;
}

/// Calls f(i, j, k) for the cells that the triangle's box meets.
template <class F>
void for_cells_of(const RayParity& s, const std::array<int, 3>& t, F f) {
  const auto [low, high] = box_of(s, t);
  for (int k = cell_along(s, 2, low.z()); k <= cell_along(s, 2, high.z()); ++k)
    for (int j = cell_along(s, 1, low.y()); j <= cell_along(s, 1, high.y()); ++j)
      for (int i = cell_along(s, 0, low.x()); i <= cell_along(s, 0, high.x()); ++i) f(i, j, k);
}

void fill_buckets(RayParity& s) {
  const int columns = s.count[0] * s.count[1];
  std::vector<std::vector<int>> buckets(columns);
  for (std::size_t t = 0; t < s.triangles.size(); ++t)
    for_cells_of(s, s.triangles[t], [&](int i, int j, int) {
      auto& bucket = buckets[j * s.count[0] + i];
      if (bucket.empty() || bucket.back() != static_cast<int>(t)) bucket.push_back(static_cast<int>(t));
    });
  s.bucket_start.assign(1, 0);
  for (const auto& bucket : buckets) {
    s.bucket_items.insert(s.bucket_items.end(), bucket.begin(), bucket.end());
    s.bucket_start.push_back(static_cast<int>(s.bucket_items.size()));
  }
}

void classify_cells(RayParity& s) {
  s.cell.assign(std::size_t(s.count[0]) * s.count[1] * s.count[2], outside_cell);
  const auto number = [&](int i, int j, int k) { return (std::size_t(k) * s.count[1] + j) * s.count[0] + i; };
  for (const auto& t : s.triangles)
    for_cells_of(s, t, [&](int i, int j, int k) { s.cell[number(i, j, k)] = surface_cell; });
  for (int k = 0; k < s.count[2]; ++k)
    for (int j = 0; j < s.count[1]; ++j)
      for (int i = 0; i < s.count[0]; ++i) {
        char& state = s.cell[number(i, j, k)];
        const Vec3 centre = s.lower + s.edge.cwiseProduct(Vec3(i + 0.5, j + 0.5, k + 0.5));
        if (state != surface_cell && inside_by_ray(s, centre)) state = inside_cell;
      }
}

}  // namespace

bool RayParity::inside(const Vec3& p) const {
  std::size_t number = 0;
  for (int axis = 2; axis >= 0; --axis) {
    const double x = p[axis] - lower[axis], size = edge[axis] * count[axis];
    if (!(x >= -tolerance && x <= size + tolerance)) return false;
    number = number * count[axis] + cell_along(*this, axis, p[axis]);
  }
  return cell[number] == surface_cell ? inside_by_ray(*this, p) : cell[number] == inside_cell;
}

RayParity ray_parity(std::vector<Vec3> points, std::vector<std::array<int, 3>> triangles, double tolerance) {
  RayParity s;
  s.points = std::move(points);
  s.triangles = std::move(triangles);
  s.tolerance = tolerance;
  Vec3 upper = s.lower = s.points[s.triangles.front()[0]];
  for (const auto& t : s.triangles) {
    const auto [low, high] = box_of(s, t);
    s.lower = s.lower.cwiseMin(low);
    upper = upper.cwiseMax(high);
  }
  const Vec3 size = upper - s.lower;
  for (int axis = 0; axis < 3; ++axis) {
    s.count[axis] = std::max(1, int(std::ceil(cells_along_longest * size[axis] / size.maxCoeff())));
    s.edge[axis] = size[axis] / s.count[axis];
  }
  fill_buckets(s);
  classify_cells(s);
  return s;
}

}  // namespace springproof
