#include "msm/topology/random/repair.h"

#include <algorithm>
#include <numeric>

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
std::vector<char> detached(std::size_t nodes, const std::vector<Bond>& bonds) {
  std::vector<int> parent(nodes), size(nodes, 0);
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int n) {
    while (parent[n] != n) n = parent[n] = parent[parent[n]];
    return n;
  };
  for (const Bond& b : bonds) parent[root(b.j)] = root(b.i);
  for (std::size_t n = 0; n < nodes; ++n) ++size[root(static_cast<int>(n))];
  const int largest = static_cast<int>(std::max_element(size.begin(), size.end()) - size.begin());
  std::vector<char> off(nodes);
  for (std::size_t n = 0; n < nodes; ++n) off[n] = root(static_cast<int>(n)) != largest;
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

}  // namespace

NetworkRepair repair(std::vector<Vec3>& points, std::vector<Bond>& bonds, const Vec3& box) {
  NetworkRepair counts;
  while (!points.empty()) {
    const std::vector<Sums> sums = direction_sums(points, bonds, box);
    std::vector<char> off(points.size());
    std::transform(sums.begin(), sums.end(), off.begin(), is_floppy);
    int* count = &counts.floppy_nodes;
    if (std::count(off.begin(), off.end(), 1) == 0) {
      off = detached(points.size(), bonds);
      count = &counts.detached_nodes;
    }
    const int removed = static_cast<int>(std::count(off.begin(), off.end(), 1));
    if (removed == 0) break;
    *count += removed;
    remove(off, points, bonds);
  }
  return counts;
}

}  // namespace springproof
