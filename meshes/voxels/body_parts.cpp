#include "meshes/voxels/body_parts.h"

#include <Eigen/Geometry>
#include <map>
#include <stdexcept>
#include <tuple>

#include "meshes/facets.h"

namespace springproof {
namespace {

constexpr double least_volume = 1e-12, least_area = 1e-9;  // of a cube, of its face: below it round-off
constexpr double least_fraction = 1e-3;                    // of a cube, for a piece that is kept

double volume_of(const TetrahedronCorners& t) {
  return std::abs((t[1] - t[0]).cross(t[2] - t[0]).dot(t[3] - t[0])) / 6;
}

}  // namespace

double area_of(const TriangleCorners& t) { return (t[1] - t[0]).cross(t[2] - t[0]).norm() / 2; }

void SolidMoments::add(const TetrahedronCorners& t) {
  const double v = volume_of(t);
  const Vec3 sum = t[0] + t[1] + t[2] + t[3];
  volume += v;
  first += v / 4 * sum;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j <= i; ++j) {
      double squares = sum[i] * sum[j];
      for (const Vec3& x : t) squares += x[i] * x[j];
      second(i, j) += v / 20 * squares;
      if (j < i) second(j, i) = second(i, j);
    }
}

void SolidMoments::add(const SolidMoments& m) {
  volume += m.volume;
  first += m.first;
  second += m.second;
}

bool BodyParts::TetrahedronFacet::operator<(const TetrahedronFacet& o) const {
  return std::tie(nodes, tetrahedron) < std::tie(o.nodes, o.tetrahedron);
}

BodyParts::BodyParts(const VoxelGrid& grid, const Mesh& body) : grid_(grid), body_(body) {
  list_facets();
  X_.resize(body.nodes.rows());
  for (Eigen::Index n = 0; n < body.nodes.rows(); ++n)
    X_[n] = (body.nodes.row(n).transpose() - grid.origin) / grid.edge;
  for (const Tetrahedron& t : body.tetrahedra) {
    begin.push_back(static_cast<int>(cube.size()));
    cut_by_cells(TetrahedronCorners{X_[t[0]], X_[t[1]], X_[t[2]], X_[t[3]]}, grid,
                 [&](const std::array<int, 3>& at, const TetrahedronCorners& part) {
                   if (volume_of(part) > 0) moments[find_or_add(cube_number(grid, at))].add(part);
                 });
  }
  begin.push_back(static_cast<int>(cube.size()));
  find_mixed_cubes();
  connect();
}

void BodyParts::list_facets() {
  facets_.reserve(4 * body_.tetrahedra.size());
  for (std::size_t t = 0; t < body_.tetrahedra.size(); ++t)
    for (int f = 0; f < 4; ++f) {
      const Tetrahedron& n = body_.tetrahedra[t];
      facets_.push_back({ascending(std::array{n[f], n[(f + 1) % 4], n[(f + 2) % 4]}), static_cast<int>(t)});
    }
  std::sort(facets_.begin(), facets_.end());
}

std::array<int, 3> BodyParts::index(long at) const {
  const long row = at / grid_.cells[0];
  return {static_cast<int>(at % grid_.cells[0]), static_cast<int>(row % grid_.cells[1]),
          static_cast<int>(row / grid_.cells[1])};
}

int BodyParts::size(long at) const { return cell_size(grid_, index(at)); }

int BodyParts::find(int tetrahedron, long at) const {
  for (int p = begin[tetrahedron]; p < begin[tetrahedron + 1]; ++p)
    if (cube[p] == at) return p;
  return -1;
}

int BodyParts::find_or_add(long at) {
  for (auto p = static_cast<std::size_t>(begin.back()); p < cube.size(); ++p)
    if (cube[p] == at) return static_cast<int>(p);
  cube.push_back(at);
  moments.emplace_back();
  return static_cast<int>(cube.size()) - 1;
}

long BodyParts::cube_beside(const TriangleCorners& part, int tetrahedron) const {
  const Tetrahedron& t = body_.tetrahedra[tetrahedron];
  const Vec3 middle = (part[0] + part[1] + part[2]) / 3, inside = (X_[t[0]] + X_[t[1]] + X_[t[2]] + X_[t[3]]) / 4;
  std::array<int, 3> at;
  for (int d = 0; d < 3; ++d) {
    double x = middle[d];
    if (std::abs(x - std::round(x)) < 4 * lattice_tolerance) x = std::round(x) + (inside[d] > x ? 0.5 : -0.5);
    at[d] = std::clamp(static_cast<int>(std::floor(x)), 0, grid_.cells[d] - 1);
  }
  return cube_number(grid_, cell_at(grid_, at));
}

int BodyParts::owner(const std::array<int, 3>& of) const {
  const std::array<int, 3> nodes = ascending(of);
  const auto at = std::lower_bound(facets_.begin(), facets_.end(), TetrahedronFacet{nodes, -1});
  if (at == facets_.end() || at->nodes != nodes)
    throw std::invalid_argument("voxels: a patch has a facet that no tetrahedron has");
  return at->tetrahedron;
}

bool BodyParts::share_a_face(long a, long b) const {
  const std::array<int, 3> i = index(a), j = index(b);
  const int of_a = size(a), of_b = size(b);
  int touching = 0, overlapping = 0;
  for (int d = 0; d < 3; ++d) {
    touching += i[d] + of_a == j[d] || j[d] + of_b == i[d];
    overlapping += i[d] < j[d] + of_b && j[d] < i[d] + of_a;
  }
  return touching == 1 && overlapping == 2;
}

void BodyParts::find_mixed_cubes() {
  std::map<std::pair<long, int>, double> volumes;
  for (int t = 0; t + 1 < static_cast<int>(begin.size()); ++t)
    for (int p = begin[t]; p < begin[t + 1]; ++p) volumes[{cube[p], material(t)}] += moments[p].volume;
  long last = -1;
  for (const auto& [at, volume] : volumes) {
    if (volume < least_fraction * std::pow(size(at.first), 3)) continue;
    if (at.first == last) mixed_.insert(last);
    last = at.first;
  }
}

/// Whether a corner of their common face is one of a mixed cube.
bool BodyParts::touch_a_mixed_cube(long a, long b) const {
  const std::array<int, 3> i = index(a), j = index(b);
  for (int corner = 0; corner < 8; ++corner)
    for (int around = 0; around < 8; ++around) {
      std::array<int, 3> at;
      bool in_grid = true;
      for (int d = 0; d < 3; ++d) {
        const int low = std::max(i[d], j[d]), high = std::min(i[d] + size(a), j[d] + size(b));
        at[d] = (corner >> d & 1 ? high : low) - (around >> d & 1);
        in_grid &= at[d] >= 0 && at[d] < grid_.cells[d];
      }
      if (in_grid && mixed_.contains(cube_number(grid_, cell_at(grid_, at)))) return true;
    }
  return false;
}

void BodyParts::connect() {
  for (std::size_t t = 0; t + 1 < begin.size(); ++t)  // a convex solid in two cubes fills some of the face between them
    for (int p = begin[t]; p < begin[t + 1]; ++p)
      for (int q = begin[t]; q < p; ++q)
        if (moments[p].volume > least_volume && moments[q].volume > least_volume && share_a_face(cube[p], cube[q]))
          to_next.push_back({q, p});
  for (std::size_t f = 0; f + 1 < facets_.size(); ++f)
    if (facets_[f].nodes == facets_[f + 1].nodes)
      connect(facets_[f].nodes, facets_[f].tetrahedron, facets_[f + 1].tetrahedron);
}

void BodyParts::connect(const std::array<int, 3>& facet, int a, int b) {
  cut_by_cells_beside(triangle(facet), grid_, [&](const std::array<int, 3>&, const TriangleCorners& part) {
    if (area_of(part) < least_area) return;
    const long at = cube_beside(part, a), beyond = cube_beside(part, b);
    const int p = find(a, at), q = find(b, beyond);
    if (p < 0 || q < 0) return;
    if (at != beyond) {
      if (!share_a_face(at, beyond)) return;
      if (material(a) == material(b) || !touch_a_mixed_cube(at, beyond))
        to_next.push_back({p, q});
      else
        add_interface(p, q, a, b, part);
    } else if (material(a) == material(b))
      in_cube.push_back({p, q});
    else
      add_interface(p, q, a, b, part);
  });
}

void BodyParts::add_interface(int p, int q, int a, int b, TriangleCorners part) {
  if (material(a) > material(b)) return add_interface(q, p, b, a, part);
  const Tetrahedron& t = body_.tetrahedra[a];
  const Vec3 inside = (X_[t[0]] + X_[t[1]] + X_[t[2]] + X_[t[3]]) / 4;
  if ((part[1] - part[0]).cross(part[2] - part[0]).dot(part[0] - inside) < 0) std::swap(part[1], part[2]);
  interfaces.push_back({{p, q}, part});
}

BodyPieces::BodyPieces(const BodyParts& parts) {
  UnitedNumbers classes(parts.cube.size());
  for (const auto& [p, q] : parts.in_cube) classes.unite(p, q);
  std::vector<int> tetrahedron(parts.cube.size());
  for (int t = 0; t + 1 < static_cast<int>(parts.begin.size()); ++t)
    std::fill(tetrahedron.begin() + parts.begin[t], tetrahedron.begin() + parts.begin[t + 1], t);
  of_part.resize(parts.cube.size());
  std::vector<int> number(parts.cube.size(), -1);
  for (std::size_t p = 0; p < parts.cube.size(); ++p) {
    int& n = number[classes.of(static_cast<int>(p))];
    if (n < 0) {
      n = static_cast<int>(cube.size());
      cube.push_back(parts.cube[p]);
      capacity.push_back(std::pow(parts.size(parts.cube[p]), 3));
      material.push_back(parts.material(tetrahedron[p]));
      moments.emplace_back();
    }
    of_part[p] = n;
    moments[n].add(parts.moments[p]);
  }
  for (const auto& [p, q] : parts.to_next) links.push_back({of_part[p], of_part[q]});
  std::sort(links.begin(), links.end());
  links.erase(std::unique(links.begin(), links.end()), links.end());
  for (const BodyParts::Interface& i : parts.interfaces) meets.push_back({of_part[i.parts[0]], of_part[i.parts[1]]});
  std::sort(meets.begin(), meets.end());
  meets.erase(std::unique(meets.begin(), meets.end()), meets.end());
}

std::vector<std::array<int, 2>> BodyPieces::bonded(const std::vector<char>& large) const {
  std::vector<std::vector<int>> instead(cube.size());  // of small pieces, the large ones beside them
  for (const auto& [p, q] : links)
    if (material[p] == material[q] && large[p] != large[q]) instead[large[p] ? q : p].push_back(large[p] ? p : q);
  for (std::size_t p = 0; p < cube.size(); ++p)
    if (large[p]) instead[p] = {static_cast<int>(p)};
  std::vector<std::array<int, 2>> pairs;
  for (const auto& [p, q] : meets)
    for (const int a : instead[p])
      for (const int b : instead[q]) pairs.push_back({a, b});
  return pairs;
}

double BodyPieces::number_cells() {
  const std::size_t n = cube.size();
  std::vector<char> large(n);
  double all = 0;
  for (std::size_t p = 0; p < n; ++p) {
    large[p] = moments[p].volume >= least_fraction * capacity[p];
    all += moments[p].volume;
  }
  UnitedNumbers together(n);
  for (const auto& [p, q] : links)
    if (large[p] && large[q]) together.unite(p, q);
  for (const auto& [p, q] : bonded(large)) together.unite(p, q);
  std::vector<double> size(n, 0);
  for (std::size_t p = 0; p < n; ++p)
    if (large[p]) size[together.of(static_cast<int>(p))] += moments[p].volume;
  const auto largest = std::max_element(size.begin(), size.end());
  std::vector<int> order(n);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return std::tie(cube[a], a) < std::tie(cube[b], b); });
  cell.assign(n, -1);
  int next = 0;
  for (const int p : order)
    if (large[p] && together.of(p) == largest - size.begin()) cell[p] = next++;
  return 1 - *largest / all;
}

}  // namespace springproof
