#include "meshes/regions/mark_regions.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <set>

#include "meshes/patches/cut_mesh.h"
#include "meshes/patches/rule_region.h"
#include "meshes/volume.h"

namespace springproof {
namespace {

constexpr double on_border = 1e-9;   // of the body's size: what is so near to a border is on it
constexpr double near_border = 0.3;  // of an edge: nodes so near to a border are moved onto it where they can
constexpr int passes_of_moves = 4;
constexpr double edges_across = 4;  // of the finest mesh, across a region

/// A box, a ball or a half-space by its borders.
struct SolidShape {
  std::vector<Border> borders;
  double across = 0;  ///< its shortest extent [m]
  double volume = 0;  ///< [m^3]; 0: infinite

  /// Whether a cell reaches into it, of a ball by the box around the cell's corners.
  template <std::size_t n>
  bool is_reached_by(const std::array<Vec3, n>& corners, double slack) const {
    return std::all_of(borders.begin(), borders.end(), [&](const Border& border) {
      if (!border.is_sphere())
        return std::any_of(corners.begin(), corners.end(), [&](const Vec3& x) { return border.depth(x) > slack; });
      Vec3 low = corners[0], high = low;
      for (const Vec3& x : corners) {
        low = low.cwiseMin(x);
        high = high.cwiseMax(x);
      }
      return border.depth(border.point.cwiseMax(low).cwiseMin(high)) > slack;
    });
  }

  template <std::size_t n>
  bool holds(const std::array<Vec3, n>& corners, double slack) const {
    return std::all_of(corners.begin(), corners.end(), [&](const Vec3& x) {
      return std::all_of(borders.begin(), borders.end(), [&](const Border& b) { return b.depth(x) >= -slack; });
    });
  }
};

SolidShape shape_of(const PatchRule::Box& box) {
  const Vec3 size = box.high - box.low;
  SolidShape shape{{}, size.minCoeff(), size.prod()};
  for (int axis = 0; axis < 3; ++axis) {
    shape.borders.push_back({box.low, Vec3::Unit(axis), 0});
    shape.borders.push_back({box.high, -Vec3::Unit(axis), 0});
  }
  return shape;
}

SolidShape shape_of(const PatchRule::Near& ball) {
  return {
      {{ball.point, Vec3::Zero(), ball.radius}}, 2 * ball.radius, 4 * std::numbers::pi / 3 * std::pow(ball.radius, 3)};
}

SolidShape shape_of(const PatchRule::Beyond& side) {
  return {{{side.point, side.normal, 0}}, std::numeric_limits<double>::infinity(), 0};
}

/// Cuts tetrahedra along the borders of a shape, so that each lies on one side.
class BorderCuts {
 public:
  BorderCuts(const SolidShape& shape, double slack, CutMesh& mesh) : shape_(shape), slack_(slack), mesh_(mesh) {}

  void refine(double longest) {
    for (std::set<std::array<int, 2>> edges = too_long(longest); !edges.empty(); edges = too_long(longest))
      for (const auto& [a, b] : edges) mesh_.refine(a, b);
  }

  void along_borders() {
    for (const Border& border : shape_.borders) {
      for (int pass = 0; pass < passes_of_moves && move_onto(border); ++pass) {
      }
      for (const auto& [a, b] : crossed(border)) mesh_.bisect(a, b, X(a) + crossing(border, a, b) * (X(b) - X(a)));
    }
  }

  bool holds(const Tetrahedron& cell) const {
    for (const Border& border : shape_.borders) {
      double least = 0, most = 0;
      for (const int n : cell) {
        least = std::min(least, border.depth(X(n)));
        most = std::max(most, border.depth(X(n)));
      }
      if (least < -slack_ || (most <= slack_ && depth_of_middle(border, cell) < 0)) return false;
    }
    return true;
  }

 private:
  const Vec3& X(int node) const { return mesh_.points()[node]; }

  double depth_of_middle(const Border& border, const Tetrahedron& c) const {
    return border.depth((X(c[0]) + X(c[1]) + X(c[2]) + X(c[3])) / 4);
  }

  bool reaches(const Tetrahedron& c) const {
    return shape_.is_reached_by(std::array{X(c[0]), X(c[1]), X(c[2]), X(c[3])}, slack_);
  }

  template <class Visit>
  void for_each_edge(const Visit& visit) const {
    for (const Tetrahedron& cell : mesh_.tetrahedra()) {
      if (!reaches(cell)) continue;
      for (int i = 0; i < 4; ++i)
        for (int j = 0; j < i; ++j) visit(std::min(cell[i], cell[j]), std::max(cell[i], cell[j]));
    }
  }

  std::set<std::array<int, 2>> too_long(double longest) const {
    std::set<std::array<int, 2>> edges;
    for_each_edge([&](int a, int b) {
      if ((X(a) - X(b)).norm() > longest) edges.insert({a, b});
    });
    return edges;
  }

  /// Where on an edge the border is: at a + t (b - a); 0: nowhere between its ends.
  double crossing(const Border& border, int a, int b) const {
    const double da = border.depth(X(a)), db = border.depth(X(b));
    if (std::abs(da) <= slack_ || std::abs(db) <= slack_ || (da > 0) == (db > 0)) return 0;
    if (!border.is_sphere()) return da / (da - db);
    const Vec3 d = X(b) - X(a), from = X(a) - border.point;
    const double A = d.squaredNorm(), B = from.dot(d),
                 root = std::sqrt(B * B - A * (from.squaredNorm() - std::pow(border.radius, 2)));
    return (da > 0 ? -B + root : -B - root) / A;
  }

  std::set<std::array<int, 2>> crossed(const Border& border) const {
    std::set<std::array<int, 2>> edges;
    for_each_edge([&](int a, int b) {
      if (crossing(border, a, b) > 0) edges.insert({a, b});
    });
    return edges;
  }

  bool keeps_other_borders(const Border& border, int node, const Vec3& to) const {
    return std::all_of(shape_.borders.begin(), shape_.borders.end(), [&](const Border& other) {
      return &other == &border || std::abs(other.depth(X(node))) > slack_ || std::abs(other.depth(to)) <= slack_;
    });
  }

  /// Nodes near the border, along the edges that it cuts.
  /// @return whether one was moved
  bool move_onto(const Border& border) {
    std::vector<std::pair<double, std::array<int, 2>>> ends;  // distance over the edge's length; the node, the other
    for (const auto& [a, b] : crossed(border)) {
      const double t = crossing(border, a, b);
      if (t < near_border) ends.push_back({t, {a, b}});
      if (1 - t < near_border) ends.push_back({1 - t, {b, a}});
    }
    std::sort(ends.begin(), ends.end());
    std::set<int> moved;
    for (const auto& [t, ab] : ends) {
      const auto& [node, other] = ab;
      if (moved.contains(node) || moved.contains(other)) continue;
      const Vec3 to = X(node) + t * (X(other) - X(node));
      if (keeps_other_borders(border, node, to) && mesh_.slide(node, to)) moved.insert(node);
    }
    return !moved.empty();
  }

  const SolidShape& shape_;
  const double slack_;
  CutMesh& mesh_;
};

/// Volumes of the materials of a mesh.
std::vector<double> volumes_by_material(const Mesh& mesh, std::size_t regions) {
  const Eigen::VectorXd cells = cell_volumes(mesh, mesh.nodes);
  std::vector<double> volumes(regions + 1, 0);
  for (std::size_t c = 0; c < mesh.materials.size(); ++c)
    volumes[mesh.materials[c]] += cells[static_cast<Eigen::Index>(c)];
  return volumes;
}

double extent_of(const Mesh& mesh) {
  return (mesh.nodes.colwise().maxCoeff() - mesh.nodes.colwise().minCoeff()).norm();
}

/// Facets between the cells of a region and others, or the surface, whose nodes are all on its sphere.
std::vector<std::array<int, 3>> facets_on(const Border& sphere, std::uint8_t number, double slack, const CutMesh& cut) {
  std::map<std::array<int, 3>, int> cells;
  for (std::size_t c = 0; c < cut.cells(); ++c) {
    if (cut.materials()[c] != number) continue;
    for (int without = 0; without < 4; ++without) {
      std::array<int, 3> facet{};
      for (int i = 0, n = 0; i < 4; ++i)
        if (i != without) facet[n++] = cut.tetrahedra()[c][i];
      std::sort(facet.begin(), facet.end());
      const auto is_on = [&](int n) { return std::abs(sphere.depth(cut.points()[n])) <= slack; };
      if (std::all_of(facet.begin(), facet.end(), is_on)) ++cells[facet];
    }
  }
  std::vector<std::array<int, 3>> facets;
  for (const auto& [facet, count] : cells)
    if (count == 1) facets.push_back(facet);
  return facets;
}

/// Nodes between a region and one other material, not on the surface of the body.
std::set<int> between_two(std::uint8_t number, const CutMesh& cut) {
  std::map<int, std::set<std::uint8_t>> materials;
  for (std::size_t c = 0; c < cut.cells(); ++c)
    for (const int n : cut.tetrahedra()[c]) materials[n].insert(cut.materials()[c]);
  std::set<int> nodes;
  for (const auto& [n, at] : materials)
    if (at.size() == 2 && at.contains(number) && cut.facets_at(n).empty()) nodes.insert(n);
  return nodes;
}

/// Moves the nodes on the sphere of a region outwards, where nothing else ends, until its facets, which are chords,
/// enclose the sphere's volume: the cones from the centre to the facets become as large as those to the sphere.
void give_volume(const Border& sphere, std::uint8_t number, double slack, CutMesh& cut) {
  double cones = 0, sectors = 0;
  std::set<int> on;
  for (const std::array<int, 3>& facet : facets_on(sphere, number, slack, cut)) {
    Vec3 x[3];
    for (int i = 0; i < 3; ++i) x[i] = (cut.points()[facet[i]] - sphere.point) / sphere.radius;
    const double cone = std::abs(x[0].cross(x[1]).dot(x[2]));
    cones += cone / 6;  // and of the solid angle (van Oosterom and Strackee 1983)
    sectors += 2. / 3 * std::atan2(cone, 1 + x[0].dot(x[1]) + x[1].dot(x[2]) + x[2].dot(x[0]));
    on.insert(facet.begin(), facet.end());
  }
  std::vector<int> nodes;
  std::vector<Vec3> to;
  const std::set<int> may_move = between_two(number, cut);
  for (const int n : on) {
    if (!may_move.contains(n)) continue;
    nodes.push_back(n);
    to.push_back(sphere.point + (cut.points()[n] - sphere.point) * std::cbrt(sectors / cones));
  }
  cut.move(nodes, to);
}

/// Of tetrahedra: the cells of one region, by its number, painted over those of earlier ones.
/// @return its volume, that in later regions too [m^3]
double paint(const SolidShape& shape, std::uint8_t number, double coarseness, Mesh& mesh) {
  std::vector<std::string> patches;
  for (const Patch& p : mesh.patches) patches.push_back(p.name);
  CutMesh cut(mesh);
  BorderCuts into(shape, on_border * extent_of(mesh), cut);
  if (std::isfinite(shape.across)) into.refine(shape.across / edges_across * coarseness);
  into.along_borders();
  std::vector<std::uint8_t> materials = cut.materials();
  std::vector<Eigen::Index> held;
  for (std::size_t c = 0; c < cut.cells(); ++c)
    if (into.holds(cut.tetrahedra()[c])) {
      held.push_back(static_cast<Eigen::Index>(c));
      materials[c] = std::max(materials[c], number);
    }
  cut.set_materials(std::move(materials));
  for (const Border& border : shape.borders)
    if (border.is_sphere()) give_volume(border, number, on_border * extent_of(mesh), cut);
  mesh = cut.mesh(patches);
  return cell_volumes(mesh, mesh.nodes)(held).sum();
}

/// Of hexahedra: those in the shape.
/// @return how many its border runs through
std::size_t paint_whole(const SolidShape& shape, std::uint8_t number, Mesh& mesh) {
  const double slack = on_border * extent_of(mesh);
  std::size_t cut = 0;
  for (std::size_t c = 0; c < mesh.hexahedra.size(); ++c) {
    std::array<Vec3, 8> corners;
    for (int i = 0; i < 8; ++i) corners[i] = mesh.nodes.row(mesh.hexahedra[c][i]).transpose();
    const bool inside = shape.holds(corners, slack);
    cut += !inside && shape.is_reached_by(corners, slack);
    if (inside && mesh.materials[c] < number) mesh.materials[c] = number;
  }
  return cut;
}

/// Nothing for a physical volume.
std::optional<SolidShape> shape_in(const MaterialRegion& region) {
  return std::visit(
      [](const auto& place) -> std::optional<SolidShape> {
        if constexpr (std::is_same_v<std::decay_t<decltype(place)>, std::string>)
          return {};
        else
          return shape_of(place);
      },
      region.place);
}

/// Marks one region, by its number.
/// @return its volume before later regions are painted over it [m^3]
/// @throws InputError if its border runs through hexahedra
double mark_one(const MaterialRegion& region, std::uint8_t number, double coarseness, Mesh& mesh) {
  const std::optional<SolidShape> shape = shape_in(region);
  if (shape && !mesh.tetrahedra.empty()) return paint(*shape, number, coarseness, mesh);
  if (const std::size_t cut = shape ? paint_whole(*shape, number, mesh) : 0)
    throw InputError(
        region.where,
        fmt::format("region: the border of '{}' runs through {} of {} cells of a grid (allowed: borders along "
                    "the lines of every grid, those of the reference too; or a body of voxels, whose "
                    "tetrahedra are cut)",
                    region.name, cut, mesh.hexahedra.size()));
  return volumes_by_material(mesh, std::numeric_limits<std::uint8_t>::max())[number];
}

/// @throws InputError for a region without cells
void refuse_without_cells(const MaterialRegion& region, bool covered, const Mesh& mesh) {
  const Vec3 size = (mesh.nodes.colwise().maxCoeff() - mesh.nodes.colwise().minCoeff()).transpose();
  throw InputError(
      region.where,
      fmt::format("region: '{}' holds no part of the body{} (allowed: a place in the body, of "
                  "{:.3g} x {:.3g} x {:.3g} m; or smaller cells)",
                  region.name, covered ? ", as later regions lie over all of it" : "", size[0], size[1], size[2]));
}

/// A region's share of the body, and what else is worth knowing.
/// @param own, alone its volume, and that before later regions were painted over it [m^3]
std::string share_note(const MaterialRegion& region, double own, double alone, double whole) {
  constexpr double least = 0.01;  // of a shape's volume: a ball's facets miss less
  std::string note = fmt::format("region '{}' is {:.4g} % of the body", region.name, 100 * own / whole);
  if (own >= (1 - on_border) * whole) note += ": [material] is not used";
  if (own < (1 - on_border) * alone)
    note += fmt::format("; {:.3g} % of it lies in later regions", 100 * (1 - own / alone));
  if (const std::optional<SolidShape> shape = shape_in(region); shape && alone < (1 - least) * shape->volume)
    note += fmt::format("; {:.3g} % of its box or ball lies outside of the body", 100 * (1 - alone / shape->volume));
  return note;
}

}  // namespace

std::vector<std::string> mark_regions(const std::vector<MaterialRegion>& regions, double coarseness, Mesh& mesh) {
  if (regions.empty()) return {};
  mesh.materials.resize(mesh.hexahedra.size() + mesh.tetrahedra.size(), 0);
  std::vector<double> alone;
  for (std::size_t r = 0; r < regions.size(); ++r)
    alone.push_back(mark_one(regions[r], static_cast<std::uint8_t>(r + 1), coarseness, mesh));
  const std::vector<double> volumes = volumes_by_material(mesh, regions.size());
  std::vector<std::string> notes;
  for (std::size_t r = 0; r < regions.size(); ++r) {
    if (!(volumes[r + 1] > 0)) refuse_without_cells(regions[r], alone[r] > 0, mesh);
    notes.push_back(share_note(regions[r], volumes[r + 1], alone[r], volume(mesh, mesh.nodes)));
  }
  return notes;
}

bool end_at_faces_of(const Mesh& mesh, const std::vector<MaterialRegion>& regions) {
  Mesh whole = mesh;
  whole.materials.assign(mesh.hexahedra.size(), 0);
  return std::all_of(regions.begin(), regions.end(), [&](const MaterialRegion& region) {
    const std::optional<SolidShape> shape = shape_in(region);
    return !mesh.tetrahedra.empty() || !shape || paint_whole(*shape, 1, whole) == 0;
  });
}

}  // namespace springproof
