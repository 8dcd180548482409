#include "meshes/regions/mark_regions.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <set>

#include "meshes/mesher/mesher.h"
#include "meshes/patches/cut_mesh.h"
#include "meshes/patches/rule_region.h"
#include "meshes/regions/enclosed.h"
#include "meshes/volume.h"

namespace springproof {
namespace {

constexpr double on_border = 1e-9;   // of the body's size: what is so near to a border is on it
constexpr double near_border = 0.3;  // of an edge: nodes so near to a border are moved onto it where they can
constexpr int passes_of_moves = 4;
constexpr double edges_across = 4;  // of the finest mesh, across a region
constexpr double as_on = 0.1;       // of an edge: nodes so near to a surface that cannot be moved are taken as on it
constexpr double chopped = 0.06;    // of an edge between two nodes of a surface: so far off it, it cuts off a corner
constexpr double reach_of_corner = 0.75;  // of the same edge: so far its middle is moved
constexpr int passes_of_corners = 2;

/// A plane, a sphere or a closed surface: depth is counted from it to its inner side.
struct RegionBorder {
  Border plain = {};
  std::shared_ptr<const Enclosed> surface = nullptr;

  bool is_sphere() const { return !surface && plain.is_sphere(); }
  double depth(const Vec3& x) const { return surface ? surface->depth(x) : plain.depth(x); }
};

/// Whether a cell may reach into a closed surface; of a hexahedron by its corners and middle alone.
template <std::size_t n>
bool reaches_into(const Enclosed& surface, const std::array<Vec3, n>& corners, double slack) {
  const Box& box = surface.box();
  Vec3 middle = Vec3::Zero(), low = corners[0], high = corners[0];
  for (const Vec3& x : corners) {
    middle += x / n;
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  if (((low - box.high).array() > slack).any() || ((box.low - high).array() > slack).any()) return false;
  double farthest = 0;
  for (const Vec3& x : corners) farthest = std::max(farthest, (x - middle).norm());
  return surface.depth(middle) + (n == 4 ? farthest : 0) > slack ||
         std::any_of(corners.begin(), corners.end(), [&](const Vec3& x) { return surface.depth(x) > slack; });
}

/// A box, a ball, a half-space or what a surface encloses, by its borders.
struct SolidShape {
  std::vector<RegionBorder> borders;
  double across = 0;  ///< its shortest extent [m]
  double volume = 0;  ///< [m^3]; 0: infinite

  /// Whether a cell reaches into it, of a ball by the box around the cell's corners.
  template <std::size_t n>
  bool is_reached_by(const std::array<Vec3, n>& corners, double slack) const {
    return std::all_of(borders.begin(), borders.end(), [&](const RegionBorder& border) {
      if (border.surface) return reaches_into(*border.surface, corners, slack);
      if (!border.is_sphere())
        return std::any_of(corners.begin(), corners.end(), [&](const Vec3& x) { return border.depth(x) > slack; });
      Vec3 low = corners[0], high = low;
      for (const Vec3& x : corners) {
        low = low.cwiseMin(x);
        high = high.cwiseMax(x);
      }
      return border.depth(border.plain.point.cwiseMax(low).cwiseMin(high)) > slack;
    });
  }

  template <std::size_t n>
  bool holds(const std::array<Vec3, n>& corners, double slack) const {
    return std::all_of(corners.begin(), corners.end(), [&](const Vec3& x) {
      return std::all_of(borders.begin(), borders.end(), [&](const RegionBorder& b) { return b.depth(x) >= -slack; });
    });
  }
};

SolidShape shape_of(const PatchRule::Box& box) {
  const Vec3 size = box.high - box.low;
  SolidShape shape{{}, size.minCoeff(), size.prod()};
  for (int axis = 0; axis < 3; ++axis) {
    shape.borders.push_back({{box.low, Vec3::Unit(axis), 0}});
    shape.borders.push_back({{box.high, -Vec3::Unit(axis), 0}});
  }
  return shape;
}

SolidShape shape_of(const PatchRule::Near& ball) {
  return {{{{ball.point, Vec3::Zero(), ball.radius}}},
          2 * ball.radius,
          4 * std::numbers::pi / 3 * std::pow(ball.radius, 3)};
}

SolidShape shape_of(const PatchRule::Beyond& side) {
  return {{{{side.point, side.normal, 0}}}, std::numeric_limits<double>::infinity(), 0};
}

/// Its extent is that of a ball of the same ratio of volume to area, if its box is not shorter.
SolidShape shape_of(const Surface& facets) {
  const Box box = bounding_box(facets);
  const double inside = springproof::volume(facets);
  return {{{{}, std::make_shared<const Enclosed>(facets)}},
          std::min((box.high - box.low).minCoeff(), 6 * inside / area(facets)),
          inside};
}

SolidShape shape_of(const EnclosedPlace& place) { return shape_of(closed_surface(place.file, place.scale).facets); }

/// Cuts tetrahedra along the borders of a shape, so that each lies on one side.
class BorderCuts {
 public:
  BorderCuts(const SolidShape& shape, double slack, CutMesh& mesh) : shape_(shape), slack_(slack), mesh_(mesh) {}

  void refine(double longest) {
    for (std::set<std::array<int, 2>> edges = too_long(longest); !edges.empty(); edges = too_long(longest))
      for (const auto& [a, b] : edges) mesh_.refine(a, b);
  }

  void along_borders() {
    for (const RegionBorder& border : shape_.borders) {
      if (border.surface) take_as_on(border);
      for (int pass = 0; pass < passes_of_moves && move_onto(border); ++pass) {
      }
      for (const auto& [a, b] : crossed(border))
        set_on(border, mesh_.bisect(a, b, X(a) + crossing(border, a, b) * (X(b) - X(a))));
      for (int pass = 0; border.surface && pass < passes_of_corners; ++pass) onto_sharp_edges(border);
    }
  }

  bool holds(const Tetrahedron& cell) const {
    for (const RegionBorder& border : shape_.borders) {
      double least = 0, most = 0;
      for (const int n : cell) {
        least = std::min(least, depth(border, n));
        most = std::max(most, depth(border, n));
      }
      if (least < -slack_ || (most <= slack_ && depth_of_middle(border, cell) < 0)) return false;
    }
    return true;
  }

 private:
  const Vec3& X(int node) const { return mesh_.points()[node]; }

  /// Depths in a surface are kept.
  double depth(const RegionBorder& border, int node) const {
    if (!border.surface) return border.depth(X(node));
    double& kept = kept_depth(node);
    if (std::isnan(kept)) kept = border.depth(X(node));
    return kept;
  }

  double& kept_depth(int node) const {
    if (depths_.size() <= static_cast<std::size_t>(node))
      depths_.resize(mesh_.points().size(), std::numeric_limits<double>::quiet_NaN());
    return depths_[node];
  }

  void set_on(const RegionBorder& border, int node) {
    if (border.surface) kept_depth(node) = 0;
  }

  double depth_of_middle(const RegionBorder& border, const Tetrahedron& c) const {
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

  /// Where an edge from a node of the surface ceases to run along it; 0: at once.
  double leaving(const Enclosed& surface, const Vec3& a, const Vec3& b) const {
    constexpr double along = 0.02, least = 0.2;  // of the edge: so near is on it, so far it has to run
    constexpr int halvings = 12;
    const double near = -along * (b - a).norm();
    if (surface.depth(a + least * (b - a)) < near) return 0;
    double s = least, t = 1;
    for (int n = 0; n < halvings; ++n) {
      const double middle = (s + t) / 2;
      (surface.depth(a + middle * (b - a)) < near ? t : s) = middle;
    }
    return std::max(least, s - along);
  }

  /// By false position (Illinois).
  double crossing_of_surface(const Enclosed& surface, const Vec3& a, const Vec3& b, double da, double db) const {
    constexpr int most = 60;
    double s = 0, t = 1, at = 0.5;
    int kept = 0;
    for (int n = 0; n < most; ++n) {
      at = (da * t - db * s) / (da - db);
      const double d = surface.depth(a + at * (b - a));
      if (std::abs(d) <= slack_) break;
      const int side = (d > 0) == (db > 0) ? 1 : -1;
      (side > 0 ? t : s) = at;
      (side > 0 ? db : da) = d;
      if (side == kept) (side > 0 ? da : db) /= 2;
      kept = side;
    }
    return at;
  }

  /// Where on an edge the border is: at a + t (b - a); 0: nowhere between its ends.
  double crossing(const RegionBorder& border, int a, int b) const {
    const double da = depth(border, a), db = depth(border, b);
    if (border.surface && da == 0 && db < -slack_) return leaving(*border.surface, X(a), X(b));
    if (border.surface && db == 0 && da < -slack_) {
      const double t = leaving(*border.surface, X(b), X(a));
      return t > 0 ? 1 - t : 0;
    }
    if (std::abs(da) <= slack_ || std::abs(db) <= slack_ || (da > 0) == (db > 0)) return 0;
    if (border.surface) return crossing_of_surface(*border.surface, X(a), X(b), da, db);
    if (!border.is_sphere()) return da / (da - db);
    const Vec3 d = X(b) - X(a), from = X(a) - border.plain.point;
    const double A = d.squaredNorm(), B = from.dot(d),
                 root = std::sqrt(B * B - A * (from.squaredNorm() - std::pow(border.plain.radius, 2)));
    return (da > 0 ? -B + root : -B - root) / A;
  }

  std::set<std::array<int, 2>> crossed(const RegionBorder& border) const {
    std::set<std::array<int, 2>> edges;
    for_each_edge([&](int a, int b) {
      if (crossing(border, a, b) > 0) edges.insert({a, b});
    });
    return edges;
  }

  bool keeps_other_borders(const RegionBorder& border, int node, const Vec3& to) const {
    return std::all_of(shape_.borders.begin(), shape_.borders.end(), [&](const RegionBorder& other) {
      return &other == &border || std::abs(other.depth(X(node))) > slack_ || std::abs(other.depth(to)) <= slack_;
    });
  }

  /// Nodes near the border, along the edges that it cuts.
  /// @return whether one was moved
  bool move_onto(const RegionBorder& border) {
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
      if (!keeps_other_borders(border, node, to) || !mesh_.slide(node, to)) continue;
      moved.insert(node);
      set_on(border, node);
    }
    return !moved.empty();
  }

  /// Nodes of the body's surface and of other regions that are nearly on a surface: gaps and slivers as thin are none.
  void take_as_on(const RegionBorder& border) {
    std::map<int, double> shortest;  // edge at a node
    for_each_edge([&](int a, int b) {
      const double length = (X(a) - X(b)).norm();
      for (const int n : {a, b}) {
        const auto [at, first] = shortest.emplace(n, length);
        if (!first) at->second = std::min(at->second, length);
      }
    });
    for (const auto& [n, edge] : shortest)
      if ((!mesh_.facets_at(n).empty() || mesh_.is_between_materials(n)) && std::abs(depth(border, n)) < as_on * edge)
        set_on(border, n);
  }

  /// Edges that cut off what the surface has beyond them get its sharp edge for a node.
  void onto_sharp_edges(const RegionBorder& border) {
    std::map<std::array<int, 2>, Vec3> beyond;
    for_each_edge([&](int a, int b) {
      if (depth(border, a) != 0 || depth(border, b) != 0 || beyond.contains({a, b})) return;
      const Vec3 middle = (X(a) + X(b)) / 2;
      const double length = (X(a) - X(b)).norm();
      if (std::abs(border.depth(middle)) < chopped * length) return;
      if (const auto at = border.surface->on_sharp_edge(middle, reach_of_corner * length)) beyond[{a, b}] = *at;
    });
    for (const auto& [edge, at] : beyond) {
      const int node = mesh_.bisect(edge[0], edge[1], (X(edge[0]) + X(edge[1])) / 2);
      mesh_.slide(node, at);
      set_on(border, node);
    }
  }

  const SolidShape& shape_;
  const double slack_;
  CutMesh& mesh_;
  mutable std::vector<double> depths_;  // of the nodes in the surface; nan: not known
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
  std::vector<std::size_t> held;
  for (std::size_t c = 0; c < cut.cells(); ++c)
    if (into.holds(cut.tetrahedra()[c])) {
      held.push_back(c);
      materials[c] = std::max(materials[c], number);
    }
  cut.set_materials(std::move(materials));
  for (const RegionBorder& border : shape.borders)
    if (border.is_sphere()) give_volume(border.plain, number, on_border * extent_of(mesh), cut);
  mesh = cut.mesh(patches);
  const Eigen::VectorXd volumes = cell_volumes(mesh, mesh.nodes);
  double sum = 0;
  for (const std::size_t c : held) sum += volumes[static_cast<Eigen::Index>(c)];
  return sum;
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
/// @throws InputError for a file without a closed surface
std::optional<SolidShape> shape_in(const MaterialRegion& region) try {
  return std::visit(
      [](const auto& place) -> std::optional<SolidShape> {
        if constexpr (std::is_same_v<std::decay_t<decltype(place)>, std::string>)
          return {};
        else
          return shape_of(place);
      },
      region.place);
} catch (const InputError& e) {
  throw InputError(region.where, fmt::format("region '{}': {}", region.name, e.what()));
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

/// Where a surface lies, for files in other units.
std::string surface_words(const MaterialRegion& region) {
  const auto* place = std::get_if<EnclosedPlace>(&region.place);
  if (!place) return {};
  const Box box = bounding_box(closed_surface(place->file, place->scale).facets);
  const auto corner = [](const Vec3& x) { return fmt::format("({:.3g}, {:.3g}, {:.3g})", x[0], x[1], x[2]); };
  return fmt::format(": its surface reaches from {} to {} m, with scale = {:g}", corner(box.low), corner(box.high),
                     place->scale);
}

/// @throws InputError for a region without cells
void refuse_without_cells(const MaterialRegion& region, bool covered, const Mesh& mesh) {
  const Vec3 size = (mesh.nodes.colwise().maxCoeff() - mesh.nodes.colwise().minCoeff()).transpose();
  throw InputError(region.where,
                   fmt::format("region: '{}' holds no part of the body{} (allowed: a place in the body, of "
                               "{:.3g} x {:.3g} x {:.3g} m; or smaller cells)",
                               region.name, covered ? ", as later regions lie over all of it" : surface_words(region),
                               size[0], size[1], size[2]));
}

/// A region's share of the body, and what else is worth knowing.
/// @param own, alone its volume, and that before later regions were painted over it [m^3]
std::string share_note(const MaterialRegion& region, double own, double alone, double whole) {
  const bool by_chords = std::holds_alternative<EnclosedPlace>(region.place);
  const double least = by_chords ? 0.05 : 0.01;  // of a shape's volume: its facets miss less
  std::string note = fmt::format("region '{}' is {:.4g} % of the body", region.name, 100 * own / whole);
  if (own >= (1 - on_border) * whole) note += ": [material] is not used";
  if (own < (1 - on_border) * alone)
    note += fmt::format("; {:.3g} % of it lies in later regions", 100 * (1 - own / alone));
  if (const std::optional<SolidShape> shape = shape_in(region); shape && alone < (1 - least) * shape->volume)
    note += fmt::format("; {:.3g} % of its shape lies outside of the body", 100 * (1 - alone / shape->volume));
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

void mark_enclosed(const Surface& surface, std::uint8_t number, double coarseness, Mesh& mesh) {
  mesh.materials.resize(mesh.tetrahedra.size(), 0);
  paint(shape_of(surface), number, coarseness, mesh);
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
