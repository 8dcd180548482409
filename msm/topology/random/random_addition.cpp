#include "msm/topology/random/random_addition.h"

#include <Eigen/Geometry>
#include <cstdint>
#include <utility>

namespace springproof {
namespace {

constexpr int deepest_level = 16;
constexpr std::size_t fewest_draws = 256;  // between two decisions to subdivide
constexpr std::size_t success_rate = 8;    // subdivide when fewer than one draw in so many succeeds

std::size_t draw_index(std::mt19937_64& random, std::size_t count) {
  return std::min(count - 1, static_cast<std::size_t>(uniform(random) * double(count)));
}

/// Whether one exclusion ball covers all the corners, and so their convex hull.
template <class Corners>
bool is_covered(const Sample& sample, const Corners& corners) {
  const double reach = sample.min_distance * sample.min_distance;
  return sample.cells.any_near(corners[0], [&](int p) {
    for (const Vec3& c : corners)
      if (!(sample.cells.nearest_image(c - sample.points[p]).squaredNorm() < reach)) return false;
    return true;
  });
}

/// Equal boxes, by their index in a lattice whose edge halves with each level.
struct Boxes {
  Vec3 lower, edge;
  const std::function<bool(const Vec3&)>& inside;
  std::vector<std::array<std::uint32_t, 3>> parts;

  Vec3 corner(const std::array<std::uint32_t, 3>& part, double x, double y, double z) const {
    return lower + edge.cwiseProduct(Vec3(part[0] + x, part[1] + y, part[2] + z));
  }
  std::array<Vec3, 8> corners(const std::array<std::uint32_t, 3>& part) const {
    std::array<Vec3, 8> all;
    for (int c = 0; c < 8; ++c) all[c] = corner(part, c & 1, c >> 1 & 1, c >> 2);
    return all;
  }
  Vec3 draw(std::mt19937_64& random) const {
    const auto& part = parts[draw_index(random, parts.size())];
    const double x = uniform(random), y = uniform(random), z = uniform(random);
    return corner(part, x, y, z);
  }
  bool may_hold_points(const std::array<std::uint32_t, 3>& part) const {
    if (!inside || inside(corner(part, 0.5, 0.5, 0.5))) return true;
    const auto all = corners(part);
    return std::any_of(all.begin(), all.end(), std::ref(inside));
  }
  void subdivide(const Sample& sample) {
    std::vector<std::array<std::uint32_t, 3>> finer;
    std::vector<Vec3> away;  // from the nodes near a part to its centre
    const double reach = sample.min_distance * sample.min_distance, near = sample.min_distance + edge.norm() / 2;
    for (const auto& part : parts) {
      const Vec3 centre = corner(part, 0.5, 0.5, 0.5);
      away.clear();
      sample.cells.for_near(centre, 1, [&](int p) {
        const Vec3 d = sample.cells.nearest_image(centre - sample.points[p]);
        if (d.squaredNorm() < near * near) away.push_back(d);
      });
      for (std::uint32_t c = 0; c < 8; ++c) {
        const Vec3 shift = edge.cwiseProduct(Vec3(c & 1, c >> 1 & 1, c >> 2) - Vec3(0.5, 0.5, 0.5)) / 2;
        const bool covered =
            std::any_of(away.begin(), away.end(), [&](const Vec3& d) {  // the corner farthest from the node
              return ((d + shift).cwiseAbs() + edge / 4).squaredNorm() < reach;
            });
        if (!covered) finer.push_back({2 * part[0] + (c & 1), 2 * part[1] + (c >> 1 & 1), 2 * part[2] + (c >> 2)});
      }
    }
    edge /= 2;
    parts = std::move(finer);
    if (inside) std::erase_if(parts, [&](const auto& part) { return !may_hold_points(part); });
  }
};

double measure(const std::array<Vec3, 2>& edge) { return (edge[1] - edge[0]).norm(); }
double measure(const std::array<Vec3, 3>& t) { return (t[1] - t[0]).cross(t[2] - t[0]).norm() / 2; }

Vec3 point_of(const std::array<Vec3, 2>& edge, std::mt19937_64& random) {
  return edge[0] + uniform(random) * (edge[1] - edge[0]);
}
Vec3 point_of(const std::array<Vec3, 3>& t, std::mt19937_64& random) {
  double u = uniform(random), v = uniform(random);
  if (u + v > 1) {
    u = 1 - u;
    v = 1 - v;
  }
  return t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]);
}

std::array<std::array<Vec3, 2>, 2> pieces(const std::array<Vec3, 2>& edge) {
  const Vec3 middle = (edge[0] + edge[1]) / 2;
  return {{{edge[0], middle}, {middle, edge[1]}}};
}
std::array<std::array<Vec3, 3>, 4> pieces(const std::array<Vec3, 3>& t) {
  const Vec3 ab = (t[0] + t[1]) / 2, bc = (t[1] + t[2]) / 2, ca = (t[2] + t[0]) / 2;
  return {{{t[0], ab, ca}, {ab, t[1], bc}, {ca, bc, t[2]}, {ab, bc, ca}}};
}

/// Edges or triangles, drawn in proportion to length or area.
template <class Simplex>
struct Simplices {
  std::vector<Simplex> parts;
  std::vector<double> sums;  // cumulative measures of the parts

  explicit Simplices(std::vector<Simplex> all) : parts(std::move(all)) { add_up(); }

  void add_up() {
    sums.clear();
    double sum = 0;
    for (const Simplex& part : parts) sums.push_back(sum += measure(part));
  }
  Vec3 draw(std::mt19937_64& random) const {
    const auto place = std::upper_bound(sums.begin(), sums.end(), uniform(random) * sums.back());
    return point_of(parts[std::min<std::size_t>(place - sums.begin(), parts.size() - 1)], random);
  }
  void subdivide(const Sample& sample) {
    std::vector<Simplex> finer;
    for (const Simplex& part : parts)
      for (const Simplex& piece : pieces(part))
        if (!is_covered(sample, piece)) finer.push_back(piece);
    parts = std::move(finer);
    add_up();
  }
};

template <class Domain>
int fill(Sample& sample, Domain& domain, const std::function<bool(const Vec3&)>& inside, long wanted) {
  long added = 0;
  for (int level = 0; added < wanted && !domain.parts.empty();) {
    const std::size_t draws = std::max(fewest_draws, domain.parts.size());
    std::size_t successes = 0;
    for (std::size_t d = 0; d < draws && added < wanted; ++d) {
      const Vec3 x = domain.draw(sample.random);
      if (!sample.is_free(x) || (inside && !inside(x))) continue;
      sample.add(x);
      ++successes;
      ++added;
    }
    if (added == wanted || success_rate * successes >= draws) continue;
    if (++level > deepest_level) break;
    domain.subdivide(sample);
  }
  return static_cast<int>(added);
}

}  // namespace

double uniform(std::mt19937_64& random) { return double(random() >> 11) * 0x1.0p-53; }

bool Sample::is_free(const Vec3& x) const {
  const double reach = min_distance * min_distance;
  return !cells.any_near(x, [&](int p) { return cells.nearest_image(x - points[p]).squaredNorm() < reach; });
}

void Sample::add(const Vec3& x) {
  points.push_back(x);
  cells.add(x);
}

int fill_box(Sample& sample, const Vec3& lower, const Vec3& upper, const std::function<bool(const Vec3&)>& inside,
             long wanted) {
  std::array<std::uint32_t, 3> count;
  for (int a = 0; a < 3; ++a)
    count[a] =
        static_cast<std::uint32_t>(std::clamp(std::ceil((upper[a] - lower[a]) / sample.min_distance), 1.0, 65535.0));
  Boxes boxes{lower, (upper - lower).cwiseQuotient(Vec3(count[0], count[1], count[2])), inside, {}};
  for (std::uint32_t k = 0; k < count[2]; ++k)
    for (std::uint32_t j = 0; j < count[1]; ++j)
      for (std::uint32_t i = 0; i < count[0]; ++i) boxes.parts.push_back({i, j, k});
  return fill(sample, boxes, inside, wanted);
}

int fill_triangles(Sample& sample, const std::vector<std::array<Vec3, 3>>& triangles, long wanted) {
  Simplices<std::array<Vec3, 3>> domain(triangles);
  return fill(sample, domain, {}, wanted);
}

int fill_edges(Sample& sample, const std::vector<std::array<Vec3, 2>>& edges, long wanted) {
  Simplices<std::array<Vec3, 2>> domain(edges);
  return fill(sample, domain, {}, wanted);
}

}  // namespace springproof
