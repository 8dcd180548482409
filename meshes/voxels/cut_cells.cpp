#include "meshes/voxels/cut_cells.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <set>
#include <stdexcept>

#include "meshes/locate/outer_facets.h"
#include "meshes/voxels/body_parts.h"

namespace springproof {
namespace {

constexpr double largest_loss = 0.02, noted_loss = 1e-3, noted_thin = 0.02;
constexpr double thin = 0.75;  // 2 V / A in edges: sheets of that thickness, rods of twice that diameter

/// Of a piece in a cell, from its moments about the origin of the grid.
FilledPart part_in_cell(const SolidMoments& m, const std::array<int, 3>& at, double size) {
  const Vec3 centre = Vec3(at[0], at[1], at[2]) + Vec3::Constant(size / 2);
  return filled_part(m.volume / std::pow(size, 3), (m.first - m.volume * centre) / std::pow(size, 4),
                     (m.second - centre * m.first.transpose() - m.first * centre.transpose() +
                      m.volume * centre * centre.transpose()) /
                         std::pow(size, 5));
}

/// Gives the cells corners: those on a face through which two cells are connected are the same.
void number_points(const BodyPieces& pieces, CutBody& out) {
  std::vector<LatticeCube> cubes;
  for (const CutCell& c : out.cells) cubes.push_back({c.index, c.size});
  std::vector<std::array<int, 2>> links;
  for (const auto& [p, q] : pieces.links)
    if (pieces.cell[p] >= 0 && pieces.cell[q] >= 0) links.push_back({pieces.cell[p], pieces.cell[q]});
  JoinedCubes joined = join_cubes(cubes, links);
  for (std::size_t c = 0; c < cubes.size(); ++c) out.cells[c].corners = joined.corners[c];
  out.carried = std::move(joined.carried);
  out.points.resize(static_cast<Eigen::Index>(joined.points.size()), 3);
  for (std::size_t p = 0; p < joined.points.size(); ++p) {
    const auto [i, j, k] = joined.points[p];
    out.points.row(static_cast<Eigen::Index>(p)) = (out.grid.origin + out.grid.edge * Vec3(i, j, k)).transpose();
  }
}

/// Quadrature on a triangle, exact to degree 4 (Strang and Fix, six points): barycentric coordinates and weights.
struct TrianglePoint {
  std::array<double, 3> at;
  double weight;
};
std::vector<TrianglePoint> triangle_points() {
  std::vector<TrianglePoint> points;
  const double a[2] = {0.44594849091596489, 0.09157621350977073}, w[2] = {0.22338158967801147, 0.10995174365532187};
  for (int k = 0; k < 2; ++k)
    for (int i = 0; i < 3; ++i) {
      TrianglePoint p{{a[k], a[k], a[k]}, w[k]};
      p.at[i] = 1 - 2 * a[k];
      points.push_back(p);
    }
  return points;
}

}  // namespace

FilledPart filled_part(double volume, const Vec3& first, const Eigen::Matrix3d& second) {
  constexpr double round_off = 1e-10;
  if (std::abs(volume - 1) < round_off) return {};
  FilledPart f;
  f.fraction = volume;
  f.mean = first / volume;
  for (int i = 0; i < 3; ++i) {
    f.mixed[i] = second((i + 1) % 3, (i + 2) % 3) / volume;
    f.variance[i] = std::max(0.0, second(i, i) / volume - f.mean[i] * f.mean[i]);
  }
  return f;
}

Eigen::Matrix3d second_moments(const FilledPart& part) {
  Eigen::Matrix3d second = (part.mean * part.mean.transpose()).eval();
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    second(i, i) += part.variance[i];
    second(j, k) = second(k, j) = part.mixed[i];
  }
  return second;
}

double PatchInCell::total_area() const { return std::accumulate(area.begin(), area.end(), 0.0); }

Vec3 CutBody::centre(int cell) const {
  const auto& [i, j, k] = cells[cell].index;
  return grid.origin + grid.edge * (Vec3(i, j, k) + Vec3::Constant(0.5 * cells[cell].size));
}

std::array<double, 8> CutBody::weights(int cell, const Vec3& point) const {
  const Vec3 xi = (point - centre(cell)) / (grid.edge * cells[cell].size);
  std::array<double, 8> w;
  w.fill(1);
  for (int n = 0; n < 8; ++n)
    for (int d = 0; d < 3; ++d) w[n] *= 0.5 + (hexahedron_corners[n][d] ? xi[d] : -xi[d]);
  return w;
}

int CutBody::nearest_cell(const Vec3& point, int material) const {
  const std::array<int, 3> at = cube_at(grid, point);
  const auto distance = [&](int c) { return (centre(c) - point).squaredNorm(); };
  for (int rings = 1; rings <= *std::max_element(grid.cells.begin(), grid.cells.end()); ++rings) {
    int best = -1;
    for (int k = std::max(0, at[2] - rings); k <= std::min(grid.cells[2] - 1, at[2] + rings); ++k)
      for (int j = std::max(0, at[1] - rings); j <= std::min(grid.cells[1] - 1, at[1] + rings); ++j)
        for (int i = std::max(0, at[0] - rings); i <= std::min(grid.cells[0] - 1, at[0] + rings); ++i) {
          const auto here = cells_of_.find(cube_number(grid, cell_at(grid, {i, j, k})));
          if (here == cells_of_.end()) continue;
          for (const int c : here->second)
            if (cells[c].material == material && (best < 0 || distance(c) < distance(best))) best = c;
        }
    if (best >= 0) return best;
  }
  throw std::invalid_argument("voxels: the body has no cells");
}

CutBody::Place CutBody::place(const Vec3& point) const {
  const auto tetrahedron = (*locator_)(point).cell;
  const long cube = cube_number(grid, cell_at(grid, cube_at(grid, point)));
  int best = -1;
  double least = std::numeric_limits<double>::infinity();
  for (int p = part_begin_[tetrahedron]; p < part_begin_[tetrahedron + 1]; ++p) {
    const auto [own, cell] = part_[p];
    if (cell < 0) continue;
    const double distance = own == cube ? -1 : (centre(cell) - point).squaredNorm();
    if (distance < least) {
      least = distance;
      best = cell;
    }
  }
  if (best < 0) best = nearest_cell(point, materials_.empty() ? 0 : materials_[tetrahedron]);
  return {best, weights(best, point)};
}

namespace {

using NearestCell = std::function<int(const Vec3& point, int material)>;

Vec3 middle_of(const TriangleCorners& part, const VoxelGrid& grid) {
  return grid.origin + grid.edge * (1.0 / 3 * part[0] + 1.0 / 3 * part[1] + 1.0 / 3 * part[2]);
}

/// The cell of a part of a facet of the tetrahedron `owner`; where it is left out the nearest of its material.
int cell_of(const TriangleCorners& part, int owner, const BodyParts& parts, const BodyPieces& pieces,
            const NearestCell& nearest, const VoxelGrid& grid) {
  const int p = parts.find(owner, parts.cube_beside(part, owner));
  const int cell = p < 0 ? -1 : pieces.cell[pieces.of_part[p]];
  return cell >= 0 ? cell : nearest(middle_of(part, grid), parts.material(owner));
}

PatchInCell patch_in(int cell) {
  PatchInCell patch{cell, {}, {}, {}};
  patch.normal.fill(Vec3::Zero());
  patch.moment.fill(Vec3::Zero());
  return patch;
}

/// Adds the integrals over a triangle [edges of the grid].
void add_triangle(const TriangleCorners& part, const CutBody& body, PatchInCell& to) {
  static const std::vector<TrianglePoint> rule = triangle_points();
  const double l = body.grid.edge;
  const Vec3 normal = l * l * (part[1] - part[0]).cross(part[2] - part[0]) / 2;
  for (const TrianglePoint& q : rule) {
    const Vec3 x = body.grid.origin + l * (q.at[0] * part[0] + q.at[1] * part[1] + q.at[2] * part[2]);
    const std::array<double, 8> N = body.weights(to.cell, x);
    for (int n = 0; n < 8; ++n) {
      const double area = q.weight * N[n] * normal.norm();
      to.area[n] += area;
      to.normal[n] += q.weight * N[n] * normal;
      to.moment[n] += area * (x - body.centre(to.cell));
    }
  }
}

void add_patches(const Mesh& body, const BodyParts& parts, const BodyPieces& pieces, CutBody& out,
                 const NearestCell& nearest) {
  for (const Patch& patch : body.patches) {
    std::map<int, PatchInCell> in_cell;
    for (const auto& f : patch.facets) {
      if (f[3] >= 0) throw std::invalid_argument("voxels: a patch has facets with four corners");
      const int owner = parts.owner({f[0], f[1], f[2]});
      cut_by_cells_beside(parts.triangle({f[0], f[1], f[2]}), out.grid,
                          [&](const std::array<int, 3>&, const TriangleCorners& part) {
                            if ((part[1] - part[0]).cross(part[2] - part[0]).isZero(0)) return;
                            const int cell = cell_of(part, owner, parts, pieces, nearest, out.grid);
                            add_triangle(part, out, in_cell.try_emplace(cell, patch_in(cell)).first->second);
                          });
    }
    for (auto& list = out.patches[patch.name]; const auto& [cell, piece] : in_cell) list.push_back(piece);
  }
}

/// The cells on both sides of a part of an interface; -1: what is left out there has no cell of its material beside it.
std::array<int, 2> cells_beside(const BodyParts::Interface& part, const BodyPieces& pieces, const CutBody& body,
                                const NearestCell& nearest) {
  constexpr double beside = 1.5;  // edges from the centre of the cube
  const Vec3 middle = middle_of(part.triangle, body.grid);
  std::array<int, 2> cells;
  for (int side = 0; side < 2; ++side) {
    const int piece = pieces.of_part[part.parts[side]];
    cells[side] = pieces.cell[piece];
    if (cells[side] >= 0) continue;
    const int near = nearest(middle, pieces.material[piece]);
    const double edge = body.grid.edge * body.cells[near].size;
    if ((body.centre(near) - middle).cwiseAbs().maxCoeff() <= beside * edge) cells[side] = near;
  }
  return cells;
}

void add_interfaces(const BodyParts& parts, const BodyPieces& pieces, CutBody& out, const NearestCell& nearest) {
  std::map<std::array<int, 2>, InterfaceInCells> between;
  for (const BodyParts::Interface& part : parts.interfaces) {
    const std::array<int, 2> cells = cells_beside(part, pieces, out, nearest);
    if (cells[0] < 0 || cells[1] < 0) continue;
    const InterfaceInCells none{{patch_in(cells[0]), patch_in(cells[1])}};
    for (PatchInCell& side : between.try_emplace(cells, none).first->second.sides)
      add_triangle(part.triangle, out, side);
  }
  for (const auto& [cells, interface] : between) out.interfaces.push_back(interface);
}

/// A corner of parts of the surface in a cell.
struct SurfaceCorner {
  int cell;
  Vec3 at;                      ///< in edges of the cubes
  Vec3 normals = Vec3::Zero();  ///< sum over the parts
  int parts = 0;
  double flatness() const { return normals.norm() / parts; }  ///< 1, less at edges and corners of the body
};

/// Those that lie farthest in the directions of the faces, edges and corners of a cube.
std::vector<SurfaceCorner> farthest(const std::vector<SurfaceCorner>& corners) {
  std::set<std::size_t> chosen;
  for (int d = 0; d < 27; ++d) {
    const Vec3 direction(d % 3 - 1, d / 3 % 3 - 1, d / 9 - 1);
    std::size_t best = 0;
    for (std::size_t c = 1; c < corners.size(); ++c)
      if (direction.dot(corners[c].at - corners[best].at) > lattice_tolerance) best = c;
    if (d != 13) chosen.insert(best);
  }
  std::vector<SurfaceCorner> all;
  for (const std::size_t c : chosen) all.push_back(corners[c]);
  return all;
}

/// The corners of the parts of the surface, cell by cell.
std::map<int, std::vector<SurfaceCorner>> surface_corners(const Mesh& body, const BodyParts& parts,
                                                          const BodyPieces& pieces, const CutBody& out,
                                                          const NearestCell& nearest) {
  std::map<int, std::vector<SurfaceCorner>> in_cell;
  for (const OuterFacet& f : outer_facets(body)) {
    const std::array<int, 3> nodes = {f.nodes[0], f.nodes[1], f.nodes[2]};
    const int owner = parts.owner(nodes);
    const TriangleCorners facet = parts.triangle(nodes);
    Vec3 normal = (facet[1] - facet[0]).cross(facet[2] - facet[0]).normalized();
    if (normal.dot(out.grid.origin + out.grid.edge * facet[0] - f.cell_centre) < 0) normal = -normal;
    cut_by_cells_beside(facet, out.grid, [&](const std::array<int, 3>&, const TriangleCorners& part) {
      const int cell = cell_of(part, owner, parts, pieces, nearest, out.grid);
      std::vector<SurfaceCorner>& corners = in_cell[cell];
      for (const Vec3& x : part) {
        auto known = std::find_if(corners.begin(), corners.end(), [&](const SurfaceCorner& c) {
          return (c.at - x).squaredNorm() < lattice_tolerance * lattice_tolerance * 100;
        });
        if (known == corners.end()) known = corners.insert(corners.end(), {cell, x});
        known->normals += normal;
        ++known->parts;
      }
    });
  }
  return in_cell;
}

/// Points of the surface that are `apart` from each other, in parts that are connected; edges and corners first.
void add_surface(const Mesh& body, const BodyParts& parts, const BodyPieces& pieces, CutBody& out,
                 const NearestCell& nearest) {
  constexpr double apart = 0.3;
  std::vector<SurfaceCorner> all;
  for (const auto& [cell, corners] : surface_corners(body, parts, pieces, out, nearest))
    for (const SurfaceCorner& c : farthest(corners)) all.push_back(c);
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.flatness() < b.flatness(); });
  std::map<int, std::vector<Vec3>> at_corner;  // of the cells, the points kept
  for (const SurfaceCorner& c : all) {
    const Hexahedron& corners = out.cells[c.cell].corners;
    const auto is_near = [&](const Vec3& x) { return (x - c.at).norm() < apart * out.cells[c.cell].size; };
    if (std::any_of(corners.begin(), corners.end(),
                    [&](int n) { return std::any_of(at_corner[n].begin(), at_corner[n].end(), is_near); }))
      continue;
    for (const int n : corners) at_corner[n].push_back(c.at);
    out.surface.push_back({c.cell, out.grid.origin + out.grid.edge * c.at});
  }
}

/// Fraction of the volume in parts that are thin against the cubes: 2 V / A of the surroundings of a cell.
double thin_fraction(const Mesh& body, const BodyParts& parts, const BodyPieces& pieces, const VoxelGrid& grid) {
  std::map<long, std::array<double, 2>> in_cube;  // volume and area
  for (std::size_t p = 0; p < pieces.cube.size(); ++p) in_cube[pieces.cube[p]][0] += pieces.moments[p].volume;
  for (const OuterFacet& f : outer_facets(body))
    cut_by_cells_beside(parts.triangle({f.nodes[0], f.nodes[1], f.nodes[2]}), grid,
                        [&](const std::array<int, 3>& at, const TriangleCorners& part) {
                          in_cube[cube_number(grid, at)][1] += area_of(part);
                        });
  double all = 0, in_thin = 0;
  for (const auto& [cube, here] : in_cube) {
    const std::array<int, 3> at = parts.index(cube);
    const int size = parts.size(cube);
    double volume = 0, surface = 0;
    for (int n = 0; n < 27; ++n) {
      const std::array<int, 3> near = {at[0] + size * (n % 3 - 1), at[1] + size * (n / 3 % 3 - 1),
                                       at[2] + size * (n / 9 - 1)};
      bool in_grid = true;
      for (int d = 0; d < 3; ++d) in_grid &= near[d] >= 0 && near[d] < grid.cells[d];
      const auto found = in_grid ? in_cube.find(cube_number(grid, cell_at(grid, near))) : in_cube.end();
      if (found == in_cube.end()) continue;
      volume += found->second[0];
      surface += found->second[1];
    }
    all += here[0];
    if (2 * volume < thin * size * surface) in_thin += here[0];
  }
  return in_thin / all;
}

void check_in_grid(const VoxelGrid& grid, const Mesh& body) {
  if (body.tetrahedra.empty()) throw std::invalid_argument("voxels: the body has no tetrahedra");
  const Vec3 slack = Vec3::Constant(2e-6 * grid.edge);
  const Vec3 end = grid.origin + grid.edge * Vec3(grid.cells[0], grid.cells[1], grid.cells[2]) + slack;
  for (const Tetrahedron& t : body.tetrahedra)
    for (const int n : t) {
      const Vec3 x = body.nodes.row(n).transpose();
      if ((x.array() < (grid.origin - slack).array()).any() || (x.array() > end.array()).any())
        throw std::invalid_argument("voxels: the body reaches out of the grid of cubes");
    }
}

void require_cells_of_all_materials(const Mesh& body, const CutBody& cut) {
  std::set<int> missing(body.materials.begin(), body.materials.end());
  for (const CutCell& c : cut.cells) missing.erase(c.material);
  if (!missing.empty())
    throw std::invalid_argument(fmt::format(
        "voxels: material {} of the body fills less than 1/1000 of every cube of {:.6g} m; take smaller voxels",
        *missing.begin(), cut.grid.edge));
}

}  // namespace

CutBody cut_body(const VoxelGrid& grid, const Mesh& body) {
  check_in_grid(grid, body);
  const BodyParts parts(grid, body);
  BodyPieces pieces(parts);
  const double left_out = pieces.number_cells();
  if (left_out > largest_loss)
    throw std::invalid_argument(fmt::format(
        "voxels: {:.3g} % of the body is connected with the rest only through less than 1/1000 of a cube of {:.6g} m; "
        "take smaller voxels",
        100 * left_out, grid.edge));
  CutBody out;
  out.grid = grid;
  out.cells.resize(std::count_if(pieces.cell.begin(), pieces.cell.end(), [](int c) { return c >= 0; }));
  for (std::size_t p = 0; p < pieces.cube.size(); ++p) {
    if (pieces.cell[p] < 0) continue;
    const std::array<int, 3> at = parts.index(pieces.cube[p]);
    const int size = parts.size(pieces.cube[p]);
    out.cells[pieces.cell[p]] = {at, {}, part_in_cell(pieces.moments[p], at, size), size, pieces.material[p]};
  }
  require_cells_of_all_materials(body, out);
  for (std::size_t c = 0; c < out.cells.size(); ++c)
    out.cells_of_[cube_number(grid, out.cells[c].index)].push_back(static_cast<int>(c));
  number_points(pieces, out);
  out.locator_ = std::make_shared<TetrahedronLocator>(body.nodes, body.tetrahedra);
  out.part_begin_ = parts.begin;
  for (std::size_t p = 0; p < parts.cube.size(); ++p)
    out.part_.emplace_back(parts.cube[p], pieces.cell[pieces.of_part[p]]);
  out.materials_ = body.materials;
  const auto nearest = [&](const Vec3& x, int material) { return out.nearest_cell(x, material); };
  add_patches(body, parts, pieces, out, nearest);
  add_interfaces(parts, pieces, out, nearest);
  add_surface(body, parts, pieces, out, nearest);
  if (left_out > noted_loss)
    out.notes.push_back(
        fmt::format("{:.2g} % of the body, in parts of less than 1/1000 of a cube of {:.4g} m or "
                    "connected only through such: left out",
                    100 * left_out, grid.edge));
  if (const double share = thin_fraction(body, parts, pieces, grid); share > noted_thin)
    out.notes.push_back(
        fmt::format("{:.2g} % of the body is thinner than about a cube of {:.4g} m, or a rod of less "
                    "than two: springs are not accurate there; take smaller voxels",
                    100 * share, grid.edge));
  return out;
}

}  // namespace springproof
