#include "meshes/regions/mark_regions.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include "meshes/mesher/mesher.h"
#include "meshes/regions/border_cuts.h"
#include "meshes/volume.h"

namespace springproof {
namespace {

constexpr double on_border = 1e-9;         // of the body's size: what is so near to a border is on it
constexpr double edges_across = 4;         // of the finest mesh, across a region, but for thin ones:
constexpr double most_in_region = 40000;   // tetrahedra of the finest mesh that shortened edges make of a region
constexpr double tetrahedra_in_cube = 65;  // whose edge is the longest of theirs, when edges are halved until they fit

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
    for (const auto& [x, y, z, none] : facets_of(cut.tetrahedra()[c])) {
      const std::array<int, 3> facet = ascending(std::array{x, y, z});
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

/// Of a region in the finest mesh [m].  A thin one may have a single quadratic element across it, by which a sheet
/// bends right.
/// @param volume of what lies in the body [m^3]
double longest_edge(const SolidShape& shape, double volume) {
  return std::max(shape.across / edges_across, std::cbrt(tetrahedra_in_cube * volume / most_in_region));
}

/// Of what lies in the box around a body, of a surface in proportion to the box around that.
double volume_within(const RegionPlace& place, const SolidShape& shape, const Mesh& mesh) {
  const auto* box = std::get_if<PatchRule::Box>(&place);
  const Enclosed* surface = shape.borders.front().surface.get();
  if (!box && !surface) return shape.volume;
  const Vec3 own_low = box ? box->low : surface->box().low, own_high = box ? box->high : surface->box().high,
             low = own_low.cwiseMax(mesh.nodes.colwise().minCoeff().transpose()),
             high = own_high.cwiseMin(mesh.nodes.colwise().maxCoeff().transpose());
  const double within = (high - low).cwiseMax(0).prod();
  return box ? within : shape.volume * within / (own_high - own_low).prod();
}

/// Of tetrahedra: the cells of one region, by its number, painted over those of earlier ones.
/// @param longest edge that one may have in the region before it is cut [m]
/// @return its volume, that in later regions too [m^3]
double paint(const SolidShape& shape, std::uint8_t number, double longest, Mesh& mesh) {
  std::vector<std::string> patches;
  for (const Patch& p : mesh.patches) patches.push_back(p.name);
  CutMesh cut(mesh);
  const double slack = on_border * extent_of(mesh);
  const std::vector<std::size_t> held = cut_along_borders(shape, longest, slack, cut);
  std::vector<std::uint8_t> materials = cut.materials();
  for (const std::size_t c : held) materials[c] = std::max(materials[c], number);
  cut.set_materials(std::move(materials));
  for (const RegionBorder& border : shape.borders)
    if (border.is_sphere()) give_volume(border.plain, number, slack, cut);
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
  if (shape && !mesh.tetrahedra.empty()) {
    const double longest = longest_edge(*shape, volume_within(region.place, *shape, mesh));
    return paint(*shape, number, coarseness * longest, mesh);
  }
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
  const SolidShape shape = shape_of(surface);
  paint(shape, number, coarseness * longest_edge(shape, shape.volume), mesh);
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
