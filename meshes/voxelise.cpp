#include "meshes/voxelise.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <stdexcept>

#include "meshes/outer_facets.h"

namespace springproof {
namespace {

constexpr double tolerance = 1e-6;  // of the box

void check_box(const Vec3& size, const std::array<int, 3>& cells, const Mesh& body) {
  const Vec3 edge = size.cwiseQuotient(Vec3(cells[0], cells[1], cells[2]));
  if (edge.maxCoeff() > (1 + tolerance) * edge.minCoeff())
    throw std::invalid_argument(fmt::format("voxels: cells of {:.6g} x {:.6g} x {:.6g} m are no cubes", edge[0], edge[1], edge[2]));
  const Vec3 low = body.nodes.colwise().minCoeff(), high = body.nodes.colwise().maxCoeff(), slack = tolerance * size;
  if ((low.array() < -slack.array()).any() || (high.array() > (size + slack).array()).any())
    throw std::invalid_argument(fmt::format("voxels: the body spans ({:.6g}, {:.6g}, {:.6g}) to ({:.6g}, {:.6g}, {:.6g}) m, which is not "
                                            "within the box from 0 to size_m",
                                            low[0], low[1], low[2], high[0], high[1], high[2]));
}

/// The cubes and their nodes, x fastest; only points that a cube uses are nodes.
Mesh cubes(const Vec3& size, const std::array<int, 3>& cells, const std::function<bool(const Vec3&)>& inside) {
  const auto [nx, ny, nz] = cells;
  const Vec3 edge = size.cwiseQuotient(Vec3(nx, ny, nz));
  const auto point = [&, nx = nx, ny = ny](int i, int j, int k) { return (k * (ny + 1) + j) * (nx + 1) + i; };
  Mesh mesh;
  std::vector<int> number(std::size_t(nx + 1) * (ny + 1) * (nz + 1), -1);
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        if (!inside(Vec3(i + 0.5, j + 0.5, k + 0.5).cwiseProduct(edge))) continue;
        Hexahedron cube;
        for (int c = 0; c < 8; ++c) {
          const auto& [di, dj, dk] = hexahedron_corners[c];
          cube[c] = point(i + di, j + dj, k + dk);
          number[cube[c]] = 0;
        }
        mesh.hexahedra.push_back(cube);
      }
  mesh.nodes.resize(std::count(number.begin(), number.end(), 0), 3);
  int next = 0;
  for (int k = 0; k <= nz; ++k)
    for (int j = 0; j <= ny; ++j)
      for (int i = 0; i <= nx; ++i)
        if (int& n = number[point(i, j, k)]; n == 0) {
          mesh.nodes.row(next) << size.x() * i / nx, size.y() * j / ny, size.z() * k / nz;
          n = next++;
        }
  for (Hexahedron& cube : mesh.hexahedra)
    for (int& n : cube) n = number[n];
  return mesh;
}

/// An outer facet of the body, and the ball that holds it.
struct BodyFacet {
  std::array<Vec3, 4> x;
  int corners;
  Vec3 middle = Vec3::Zero();
  double radius = 0;
  std::vector<std::size_t> patches;

  double distance(const Vec3& p) const {
    const double first = (closest_point(p, x[0], x[1], x[2]) - p).norm();
    return corners == 3 ? first : std::min(first, (closest_point(p, x[0], x[2], x[3]) - p).norm());
  }
};

std::vector<BodyFacet> body_facets(const Mesh& body) {
  std::map<std::array<int, 4>, std::vector<std::size_t>> patches_of;
  for (std::size_t p = 0; p < body.patches.size(); ++p)
    for (std::array<int, 4> facet : body.patches[p].facets) {
      std::sort(facet.begin(), facet.end());
      patches_of[facet].push_back(p);
    }
  std::vector<BodyFacet> facets;
  for (const OuterFacet& outer : outer_facets(body)) {
    BodyFacet f;
    f.corners = outer.nodes[3] < 0 ? 3 : 4;
    for (int c = 0; c < f.corners; ++c) f.middle += (f.x[c] = body.nodes.row(outer.nodes[c]).transpose()) / f.corners;
    for (int c = 0; c < f.corners; ++c) f.radius = std::max(f.radius, (f.x[c] - f.middle).norm());
    if (const auto it = patches_of.find(outer.key); it != patches_of.end()) f.patches = it->second;
    facets.push_back(std::move(f));
  }
  return facets;
}

const BodyFacet& nearest(const std::vector<BodyFacet>& facets, const Vec3& p) {
  const BodyFacet* best = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const BodyFacet& f : facets) {
    const double reach = least + f.radius;
    if ((f.middle - p).squaredNorm() > reach * reach) continue;
    if (const double d = f.distance(p); d < least) {
      least = d;
      best = &f;
    }
  }
  return *best;
}

void add_patches(const Mesh& body, Mesh& mesh) {
  for (const Patch& p : body.patches) mesh.patches.push_back({p.name, {}});
  const std::vector<BodyFacet> facets = body_facets(body);
  std::vector<std::array<int, 4>> outer;  // node numbers, in order of the cubes
  for (const OuterFacet& facet : outer_facets(mesh)) {
    Vec3 middle = Vec3::Zero();
    for (const int n : facet.nodes) middle += mesh.nodes.row(n).transpose() / 4;
    for (const std::size_t p : nearest(facets, middle).patches) mesh.patches[p].facets.push_back(facet.nodes);
  }
}

}  // namespace

Mesh voxelise(const Vec3& size, const std::array<int, 3>& cells, const std::function<bool(const Vec3&)>& inside, const Mesh& body) {
  check_box(size, cells, body);
  Mesh mesh = cubes(size, cells, inside);
  if (mesh.hexahedra.empty()) throw std::invalid_argument("voxels: no cube has its centre in the body; take more cells");
  if (const int parts = separate_parts(mesh); parts > 1)
    throw std::invalid_argument(fmt::format("voxels: the cubes fall into {} parts that share no node; take more cells", parts));
  add_patches(body, mesh);
  mesh.grid = detect_grid(mesh);
  return mesh;
}

}  // namespace springproof
