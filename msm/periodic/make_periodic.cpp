#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>
#include <stdexcept>
#include <tuple>

#include "msm/periodic/homogenise.h"

namespace springproof {
namespace {

using Key = std::array<long, 3>;

/// Equal for points equal up to round-off.  The odd factor keeps simple fractions away from the edges of rounding.
Key key_of(const Vec3& v) {
  constexpr double per_unit = 1234567.0 / 1.2345;
  return {std::lround(per_unit * v[0]), std::lround(per_unit * v[1]), std::lround(per_unit * v[2])};
}

/// Coordinates in units of the box, wrapped into it along its periodic axes.
Vec3 wrapped(const Vec3& x, const Vec3& lower, const Vec3& box) {
  Vec3 p = x - lower;
  for (int d = 0; d < 3; ++d)
    if (box[d] > 0) {
      p[d] /= box[d];
      p[d] -= std::floor(p[d] + 1e-9);
    }
  return p;
}

void require_images(const Vec3& box, const Network& network) {
  for (int d = 0; d < 3; ++d) {
    bool found = !(box[d] > 0);
    for (int n = 0; n < network.nodes() && !found; ++n)
      found = std::abs(network.X(n, d) - network.X(network.master(n), d)) > 0.5 * box[d];
    if (!found)
      throw std::invalid_argument(
          fmt::format("no two nodes are {} m apart along {}: the network is not periodic so", box[d], "xyz"[d]));
  }
}

/// Springs between the same masters along the same line become one.
void merge_periodic_springs(const Vec3& box, Network& network) {
  const double unit = box.maxCoeff();
  std::map<std::tuple<int, int, Key>, std::size_t> place;
  std::vector<Spring> merged;
  for (const Spring& s : network.springs) {
    int i = network.master(s.i), j = network.master(s.j);
    Key along = key_of((network.X.row(s.j) - network.X.row(s.i)).transpose() / unit);
    if (i > j || (i == j && along < Key{0, 0, 0})) {
      std::swap(i, j);
      for (long& c : along) c = -c;
    }
    const auto [at, is_new] = place.try_emplace({i, j, along}, merged.size());
    if (is_new)
      merged.push_back(s);
    else
      merged[at->second].stiffness += s.stiffness;
  }
  network.springs = std::move(merged);
}

}  // namespace

void make_periodic(const Vec3& box, Network& network) {
  const Vec3 lower = network.X.colwise().minCoeff().transpose();
  std::map<Key, int> first;
  network.image_of.resize(network.nodes());
  for (int n = 0; n < network.nodes(); ++n)
    network.image_of[n] = first.try_emplace(key_of(wrapped(network.X.row(n).transpose(), lower, box)), n).first->second;
  require_images(box, network);
  merge_periodic_springs(box, network);
}

}  // namespace springproof
