#include "support/surfaces.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <functional>
#include <map>
#include <numbers>
#include <random>
#include <set>

namespace springproof::test {
namespace {

using std::numbers::pi;
using Triangle = std::array<int, 3>;

/// A grid closed in both directions.
Surface ring(int around, int across, const std::function<Vec3(int, int)>& point) {
  Surface surface;
  const auto number = [&](int i, int j) { return i % around * across + j % across; };
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      surface.points.push_back(point(i, j));
      surface.triangles.push_back({number(i, j), number(i + 1, j), number(i + 1, j + 1)});
      surface.triangles.push_back({number(i, j), number(i + 1, j + 1), number(i, j + 1)});
    }
  if (volume(surface) < 0) return turned(surface);
  return surface;
}

Vec3 trefoil_point(double t) {
  return {std::sin(t) + 2 * std::sin(2 * t), std::cos(t) - 2 * std::cos(2 * t), -std::sin(3 * t)};
}
Vec3 trefoil_tangent(double t) {
  return {std::cos(t) + 4 * std::cos(2 * t), -std::sin(t) + 4 * std::sin(2 * t), -3 * std::cos(3 * t)};
}

/// A triangulation of the unit sphere that points may move on and leave, as long as no facet turns over.
class SphereMesh {
 public:
  explicit SphereMesh(Surface start) : surface_(std::move(start)), facets_of_(surface_.points.size()) {
    for (int f = 0; f < static_cast<int>(surface_.triangles.size()); ++f)
      for (const int p : surface_.triangles[f]) facets_of_[p].insert(f);
  }
  void move(int point, const Vec3& to) {
    const Vec3 before = surface_.points[point];
    surface_.points[point] = to.normalized();
    for (const int f : facets_of_[point])
      if (!is_outward(surface_.triangles[f])) {
        surface_.points[point] = before;
        return;
      }
  }
  /// Draws `gone` into its neighbour `kept`.
  void collapse(int gone, int kept) {
    std::set<int> around_gone = neighbours(gone), common;
    for (const int p : neighbours(kept))
      if (around_gone.contains(p)) common.insert(p);
    if (common.size() != 2) return;
    for (const int f : facets_of_[gone]) {
      Triangle t = surface_.triangles[f];
      if (facets_of_[kept].contains(f)) continue;
      std::replace(t.begin(), t.end(), gone, kept);
      if (!is_outward(t)) return;
    }
    for (const int f : std::set<int>(facets_of_[gone])) {
      Triangle& t = surface_.triangles[f];
      if (facets_of_[kept].contains(f)) {
        for (const int p : t) facets_of_[p].erase(f);
        t = {-1, -1, -1};
      } else {
        std::replace(t.begin(), t.end(), gone, kept);
        facets_of_[kept].insert(f);
      }
    }
    facets_of_[gone].clear();
  }
  std::set<int> neighbours(int point) const {
    std::set<int> found;
    for (const int f : facets_of_[point]) found.insert(surface_.triangles[f].begin(), surface_.triangles[f].end());
    found.erase(point);
    return found;
  }
  const Vec3& operator[](int point) const { return surface_.points[point]; }
  Surface result() && {
    std::map<int, int> number;
    Surface left;
    for (const Triangle& t : surface_.triangles) {
      if (t[0] < 0) continue;
      Triangle& corners = left.triangles.emplace_back();
      for (int i = 0; i < 3; ++i) {
        const auto [it, is_new] = number.try_emplace(t[i], static_cast<int>(left.points.size()));
        if (is_new) left.points.push_back(surface_.points[t[i]]);
        corners[i] = it->second;
      }
    }
    return left;
  }

 private:
  bool is_outward(const Triangle& t) const {
    const auto& x = surface_.points;
    return x[t[0]].dot(x[t[1]].cross(x[t[2]])) > 1e-9;
  }
  Surface surface_;
  std::vector<std::set<int>> facets_of_;
};

constexpr double bump = 0.25;
const Vec3& half_axes() {  // used before the globals of other units exist
  static const Vec3 axes(3, 2, 1.5);
  return axes;
}

}  // namespace

Surface sphere(double radius, int times) {
  const double g = std::numbers::phi;
  Surface s;
  s.points = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
              {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  s.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                 {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                 {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (int i = 0; i < times; ++i) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [it, is_new] = middles.try_emplace(std::minmax(a, b), static_cast<int>(s.points.size()));
      if (is_new) s.points.push_back(s.points[a].normalized() + s.points[b].normalized());
      return it->second;
    };
    std::vector<Triangle> cut;
    for (const auto& [a, b, c] : s.triangles) {
      const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      for (const Triangle& t : {Triangle{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}}) cut.push_back(t);
    }
    s.triangles = std::move(cut);
  }
  for (Vec3& p : s.points) p = radius * p.normalized();
  return s;
}

Surface globe(double radius, int rings, int around) {
  Surface s;
  s.points = {{0, 0, radius}, {0, 0, -radius}};
  const auto number = [&](int ring, int j) {
    return ring == 0 ? 0 : ring == rings ? 1 : 2 + (ring - 1) * around + j % around;
  };
  for (int i = 1; i < rings; ++i)
    for (int j = 0; j < around; ++j) {
      const double down = pi * i / rings, turn = 2 * pi * j / around;
      s.points.push_back(radius *
                         Vec3(std::sin(down) * std::cos(turn), std::sin(down) * std::sin(turn), std::cos(down)));
    }
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < around; ++j) {
      if (i > 0) s.triangles.push_back({number(i, j), number(i + 1, j), number(i, j + 1)});
      if (i < rings - 1) s.triangles.push_back({number(i, j + 1), number(i + 1, j), number(i + 1, j + 1)});
    }
  return s;
}

Surface noisy_sphere(double radius, int times, double noise, unsigned seed) {
  Surface s = sphere(radius, times);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> share(-noise, noise);
  for (Vec3& p : s.points) p *= 1 + share(random);
  return s;
}

Surface torus(double ring_radius, double tube_radius, int around, int across) {
  return ring(around, across, [&](int i, int j) {
    const double u = 2 * pi * i / around, v = 2 * pi * j / across, r = ring_radius + tube_radius * std::cos(v);
    return Vec3(r * std::cos(u), r * std::sin(u), tube_radius * std::sin(v));
  });
}

Surface trefoil(double tube_radius, int around, int across) {
  return ring(around, across, [&](int i, int j) {
    const double t = 2 * pi * i / around, v = 2 * pi * j / across;
    const Vec3 tangent = trefoil_tangent(t).normalized();
    // The knot runs round the z axis and never along it.
    const Vec3 side = tangent.cross(Vec3::UnitZ()).normalized(), up = side.cross(tangent);
    return Vec3(trefoil_point(t) + tube_radius * (std::cos(v) * side + std::sin(v) * up));
  });
}

double trefoil_length() {
  constexpr int n = 1000;  // trapezium rule of a periodic function: exact to round-off
  double length = 0;
  for (int i = 0; i < n; ++i) length += trefoil_tangent(2 * pi * i / n).norm() * 2 * pi / n;
  return length;
}

Surface scan(int times, double noise, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> share(-1, 1);
  const auto random_vector = [&] {
    const double x = share(random), y = share(random), z = share(random);
    return Vec3(x, y, z);
  };
  SphereMesh mesh(sphere(1, times));
  const int points = 10 * (1 << (2 * times)) + 2;
  const double step = 0.5 / (1 << times);
  for (int p = 0; p < points; ++p) mesh.move(p, mesh[p] + step * random_vector());
  for (int p = 0; p < points; ++p) {
    if (share(random) > 0.6 * mesh[p].x() - 0.3) continue;  // more are left where x is low
    const std::set<int> around = mesh.neighbours(p);
    if (around.empty()) continue;
    mesh.collapse(p, *std::next(around.begin(), static_cast<int>(random() % around.size())));
  }
  Surface s = std::move(mesh).result();
  for (Vec3& p : s.points) {
    const double radius = 1 + bump * 3 * std::sqrt(3.0) * p.x() * p.y() * p.z() + noise * share(random);
    p = half_axes().cwiseProduct(radius * p);
  }
  return s;
}

/// r = 1 + bump * 3 sqrt(3) xyz on the unit sphere; the integral of x^2 y^2 z^2 is 4 pi / 105.
double scan_volume() { return half_axes().prod() * 4 * pi / 3 * (1 + 81 * bump * bump / 105); }

Surface box(const Vec3& size, int n) {
  Surface s;
  std::map<Triangle, int> numbers;
  const auto number = [&](const Triangle& at) {
    const auto [it, is_new] = numbers.try_emplace(at, static_cast<int>(s.points.size()));
    if (is_new) s.points.push_back(size.cwiseProduct(Vec3(at[0], at[1], at[2])) / n);
    return it->second;
  };
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {0, n})
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          const auto corner = [&](int di, int dj) {
            Triangle at{};
            at[axis] = side;
            at[(axis + 1) % 3] = i + di;
            at[(axis + 2) % 3] = j + dj;
            return number(at);
          };
          const int a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
          if (side == 0)
            s.triangles.insert(s.triangles.end(), {Triangle{a, c, b}, Triangle{a, d, c}});
          else
            s.triangles.insert(s.triangles.end(), {Triangle{a, b, c}, Triangle{a, c, d}});
        }
  return s;
}

Surface both(const Surface& a, const Surface& b) {
  Surface s = a;
  const int shift = static_cast<int>(a.points.size());
  s.points.insert(s.points.end(), b.points.begin(), b.points.end());
  for (const auto& [i, j, k] : b.triangles) s.triangles.push_back({i + shift, j + shift, k + shift});
  return s;
}

Surface moved(Surface surface, double scale, const Vec3& by) {
  for (Vec3& p : surface.points) p = scale * p + by;
  return surface;
}

Surface turned(Surface surface) {
  for (Triangle& t : surface.triangles) std::swap(t[1], t[2]);
  return surface;
}

void write_stl_ascii(const std::filesystem::path& file, const Surface& surface) {
  std::ofstream out(file, std::ios::binary);
  out << "solid test\n";
  for (const Triangle& t : surface.triangles) {
    out << "  facet normal 0 0 0\n    outer loop\n";
    for (const int p : t) {
      const Vec3& x = surface.points[p];
      out << fmt::format("      vertex {:.9g} {:.9g} {:.9g}\n", x[0], x[1], x[2]);
    }
    out << "    endloop\n  endfacet\n";
  }
  out << "endsolid test\n";
}

void write_stl_binary(const std::filesystem::path& file, const Surface& surface) {
  std::ofstream out(file, std::ios::binary);
  std::string header = "solid as some programs begin binary files";
  header.resize(80, '\0');
  const auto count = static_cast<std::uint32_t>(surface.triangles.size());
  out << header;
  out.write(reinterpret_cast<const char*>(&count), 4);
  for (const Triangle& t : surface.triangles) {
    std::array<float, 12> numbers{};
    for (int i = 0; i < 9; ++i) numbers[i + 3] = static_cast<float>(surface.points[t[i / 3]][i % 3]);
    out.write(reinterpret_cast<const char*>(numbers.data()), sizeof numbers);
    out.write("\0", 2);
  }
}

}  // namespace springproof::test
