#include "msm/topology/random/repair.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

#include "meshes/united_numbers.h"

namespace springproof {
namespace {

constexpr int fewest_springs = 4;
constexpr double least_spread = 0.05;

struct Sums {
  int springs = 0;
  double xx = 0, yy = 0, zz = 0, xy = 0, yz = 0, zx = 0;  // of n n^T
};

/// Whether the smallest eigenvalue is below the limit: by the signs of the leading minors, which are the same on every
/// machine.
bool is_floppy(const Sums& s) {
  if (s.springs < fewest_springs) return true;
  const double limit = least_spread * (s.xx + s.yy + s.zz) / 3;
  const double a = s.xx - limit, b = s.yy - limit, c = s.zz - limit;
  const double second = a * b - s.xy * s.xy;
  const double third = c * second - s.yz * (a * s.yz - s.xy * s.zx) + s.zx * (s.xy * s.yz - b * s.zx);
  return !(a > 0 && second > 0 && third > 0);
}

std::vector<Sums> direction_sums(const std::vector<Vec3>& points, const std::vector<Bond>& bonds, const Vec3& box) {
  std::vector<Sums> sums(points.size());
  for (const Bond& bond : bonds) {
    const Vec3 d =
        points[bond.j] - points[bond.i] + box.cwiseProduct(Vec3(bond.shift[0], bond.shift[1], bond.shift[2]));
    const double square = d.squaredNorm();
    for (const int n : {bond.i, bond.j}) {
      Sums& s = sums[n];
      s.springs += 1;
      s.xx += d[0] * d[0] / square;
      s.yy += d[1] * d[1] / square;
      s.zz += d[2] * d[2] / square;
      s.xy += d[0] * d[1] / square;
      s.yz += d[1] * d[2] / square;
      s.zx += d[2] * d[0] / square;
    }
  }
  return sums;
}

/// Nodes that are not in the largest connected part.
std::vector<char> detached(int nodes, const std::vector<Bond>& bonds) {
  UnitedNumbers part(static_cast<std::size_t>(nodes));
  for (const Bond& b : bonds) part.unite(b.i, b.j);
  std::vector<int> size(static_cast<std::size_t>(nodes), 0);
  for (int n = 0; n < nodes; ++n) ++size[part.of(n)];
  const auto largest = std::max_element(size.begin(), size.end()) - size.begin();
  std::vector<char> off(size.size());
  for (int n = 0; n < nodes; ++n) off[n] = part.of(n) != largest;
  return off;
}

void remove(const std::vector<char>& off, std::vector<Vec3>& points, std::vector<Bond>& bonds) {
  std::vector<int> number(points.size(), -1);
  int kept = 0;
  for (std::size_t n = 0; n < points.size(); ++n)
    if (!off[n]) {
      points[kept] = points[n];
      number[n] = kept++;
    }
  points.resize(kept);
  std::size_t last = 0;
  for (const Bond& b : bonds)
    if (number[b.i] >= 0 && number[b.j] >= 0) bonds[last++] = {number[b.i], number[b.j], b.shift};
  bonds.resize(last);
}

/// The lowest 21 bits of three numbers, interleaved.
std::uint64_t morton(const std::array<std::uint64_t, 3>& cell) {
  std::uint64_t key = 0;
  for (int bit = 0; bit < 21; ++bit)
    for (int a = 0; a < 3; ++a) key |= (cell[a] >> bit & 1) << (3 * bit + a);
  return key;
}

bool passes_inside(const std::function<bool(const Vec3&)>& inside, const Vec3& a, const Vec3& b) {
  return !inside || (inside((a + b) / 2) && inside(a + (b - a) / 4) && inside(b + (a - b) / 4));
}

std::array<int, 3> shift_of(const PointCells& cells, const Vec3& plain, const Vec3& nearest) {
  std::array<int, 3> shift{};
  for (int a = 0; a < 3; ++a)
    if (plain[a] != nearest[a]) shift[a] = nearest[a] > plain[a] ? 1 : -1;
  return cells.periodic ? shift : std::array<int, 3>{};
}

int nearest_point(const std::vector<Vec3>& points, const PointCells& cells, const Vec3& x) {
  const double cell = cells.size.cwiseQuotient(Vec3(cells.count[0], cells.count[1], cells.count[2])).minCoeff();
  int nearest = -1;
  double distance = std::numeric_limits<double>::infinity();
  const int most_rings = *std::max_element(cells.count.begin(), cells.count.end());
  for (int rings = 1; rings <= most_rings && distance > cell * cell * (rings - 1) * (rings - 1); ++rings)
    cells.for_near(x, rings, [&](int p) {
      const double d = cells.nearest_image(points[p] - x).squaredNorm();
      if (d < distance || (d == distance && p < nearest)) {
        distance = d;
        nearest = p;
      }
    });
  return nearest;
}

}  // namespace

NetworkRepair repair(std::vector<Vec3>& points, std::vector<Bond>& bonds, const Vec3& box) {
  NetworkRepair counts;
  while (!points.empty()) {
    const std::vector<Sums> sums = direction_sums(points, bonds, box);
    std::vector<char> off(points.size());
    std::transform(sums.begin(), sums.end(), off.begin(), is_floppy);
    int* count = &counts.floppy_nodes;
    if (std::count(off.begin(), off.end(), 1) == 0) {
      off = detached(static_cast<int>(points.size()), bonds);
      count = &counts.detached_nodes;
    }
    const int removed = static_cast<int>(std::count(off.begin(), off.end(), 1));
    if (removed == 0) break;
    *count += removed;
    remove(off, points, bonds);
  }
  return counts;
}

std::vector<Vec3> spatially_sorted(const std::vector<Vec3>& points, double edge) {
  if (points.empty()) return points;
  Vec3 lower = points.front();
  for (const Vec3& p : points) lower = lower.cwiseMin(p);
  std::vector<std::pair<std::uint64_t, int>> keys;
  for (std::size_t p = 0; p < points.size(); ++p) {
    std::array<std::uint64_t, 3> cell;
    for (int a = 0; a < 3; ++a) cell[a] = static_cast<std::uint64_t>((points[p][a] - lower[a]) / edge);
    keys.emplace_back(morton(cell), static_cast<int>(p));
  }
  std::sort(keys.begin(), keys.end());
  std::vector<Vec3> sorted;
  for (const auto& [key, p] : keys) sorted.push_back(points[p]);
  return sorted;
}

std::vector<Bond> bonds_within(const std::vector<Vec3>& points, const PointCells& cells, double max_length,
                               const std::function<bool(const Vec3&)>& inside) {
  std::vector<Bond> bonds;
  for (int i = 0; i < static_cast<int>(points.size()); ++i) {
    const std::size_t first = bonds.size();
    cells.for_near(points[i], 1, [&](int j) {
      if (j <= i) return;
      const Vec3 plain = points[j] - points[i], d = cells.nearest_image(plain);
      if (d.squaredNorm() < max_length * max_length && passes_inside(inside, points[i], points[j]))
        bonds.push_back({i, j, shift_of(cells, plain, d)});
    });
    std::sort(bonds.begin() + first, bonds.end(), [](const Bond& a, const Bond& b) { return a.j < b.j; });
  }
  return bonds;
}

void join_sparse_points(const std::vector<Vec3>& points, const PointCells& cells, double max_length, int least,
                        const std::function<bool(const Vec3&)>& inside, std::vector<Bond>& bonds) {
  std::vector<std::vector<int>> joined(points.size());
  const auto join = [&](int i, int j) {
    joined[i].push_back(j);
    joined[j].push_back(i);
  };
  for (const Bond& b : bonds) join(b.i, b.j);
  for (int i = 0; i < static_cast<int>(points.size()); ++i) {
    if (static_cast<int>(joined[i].size()) >= least) continue;
    std::vector<std::pair<double, int>> others;
    cells.for_near(points[i], 2, [&](int j) {
      const double d = (points[j] - points[i]).norm();
      const bool is_new = j != i && std::find(joined[i].begin(), joined[i].end(), j) == joined[i].end();
      if (is_new && d < 2 * max_length && passes_inside(inside, points[i], points[j])) others.emplace_back(d, j);
    });
    std::sort(others.begin(), others.end());
    for (const auto& [d, j] : others) {
      if (static_cast<int>(joined[i].size()) >= least) break;
      join(i, j);
      bonds.push_back({std::min(i, j), std::max(i, j), {}});
    }
  }
  std::sort(bonds.begin(), bonds.end(),
            [](const Bond& a, const Bond& b) { return std::tie(a.i, a.j) < std::tie(b.i, b.j); });
}

double length_for(double springs_per_node, const std::vector<Vec3>& points, const Vec3& box) {
  const std::size_t wanted = static_cast<std::size_t>(springs_per_node * double(points.size()) / 2);
  // A ball that contains S + 1 nodes at the mean density has (3 (S + 1) / (4 pi n))^(1/3); look a little beyond.
  double reach = 1.2 * std::cbrt(0.239 * (springs_per_node + 1) * box.prod() / double(points.size()));
  std::vector<double> squares;
  for (; squares.size() <= wanted; reach *= 1.2) {
    PointCells cells(Vec3::Zero(), box, reach, true);
    for (const Vec3& p : points) cells.add(p);
    squares.clear();
    for (int i = 0; i < static_cast<int>(points.size()); ++i)
      cells.for_near(points[i], 1, [&](int j) {
        const double d = cells.nearest_image(points[j] - points[i]).squaredNorm();
        if (j > i && d < reach * reach) squares.push_back(d);
      });
  }
  std::nth_element(squares.begin(), squares.begin() + wanted, squares.end());
  const double above = squares[wanted], below = *std::max_element(squares.begin(), squares.begin() + wanted);
  return (std::sqrt(below) + std::sqrt(above)) / 2;
}

std::vector<double> nearest_volumes(const std::vector<Vec3>& points, const PointCells& cells, double step,
                                    double volume, const std::function<bool(const Vec3&)>& inside) {
  std::vector<double> share(points.size(), 0);
  int count[3];
  for (int a = 0; a < 3; ++a) count[a] = std::max(1, static_cast<int>(std::ceil(cells.size[a] / step)));
  const Vec3 edge = cells.size.cwiseQuotient(Vec3(count[0], count[1], count[2]));
  for (int k = 0; k < count[2]; ++k)
    for (int j = 0; j < count[1]; ++j)
      for (int i = 0; i < count[0]; ++i) {
        const Vec3 x = cells.lower + edge.cwiseProduct(Vec3(i + 0.5, j + 0.5, k + 0.5));
        if (!inside || inside(x)) share[nearest_point(points, cells, x)] += 1;
      }
  for (double& s : share) s = std::max(s, 0.5);
  const double sum = std::accumulate(share.begin(), share.end(), 0.0);
  for (double& s : share) s *= volume / sum;
  return share;
}

}  // namespace springproof
