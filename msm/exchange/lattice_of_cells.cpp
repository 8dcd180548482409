#include "msm/exchange/lattice_of_cells.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace springproof {
namespace {

constexpr double equal = 1e-9;  // relative, of stiffnesses and volumes
constexpr double most_points_per_node = 1000;

/// A pair of corners of a cell with the spring that each cell has there.
struct CornerPair {
  int a, b;
  std::optional<Spring> spring = {};  ///< of one cell
};

std::vector<CornerPair> corner_pairs() {
  std::vector<CornerPair> pairs;
  for (int a = 0; a < 8; ++a)
    for (int b = a + 1; b < 8; ++b) pairs.push_back({a, b});
  return pairs;
}

/// Number of the spring between two nodes, or -1.
int find_spring(const Network& network, int i, int j) {
  if (i > j) std::swap(i, j);
  const auto before = [](const Spring& s, const std::pair<int, int>& p) { return std::pair(s.i, s.j) < p; };
  const auto at = std::lower_bound(network.springs.begin(), network.springs.end(), std::pair(i, j), before);
  return at != network.springs.end() && at->i == i && at->j == j ? static_cast<int>(at - network.springs.begin()) : -1;
}

bool power_of_two(int n) { return (n & (n - 1)) == 0; }

/// The springs of one cell; nothing if the network's are not theirs superposed.
std::optional<std::vector<Spring>> springs_of_cell(const Network& network) {
  std::vector<CornerPair> pairs = corner_pairs();
  std::vector<int> sharing(network.springs.size(), 0);  // cells that a spring belongs to
  for (const Hexahedron& cell : network.cells.corners)
    for (const CornerPair& p : pairs)
      if (const int s = find_spring(network, cell[p.a], cell[p.b]); s >= 0) ++sharing[s];
  if (std::count(sharing.begin(), sharing.end(), 0) > 0) return {};
  for (const Hexahedron& cell : network.cells.corners)
    for (CornerPair& p : pairs) {
      const int s = find_spring(network, cell[p.a], cell[p.b]);
      // A quotient by 1, 2 or 4 is exact.
      if (s < 0 || (p.spring && !power_of_two(sharing[s]))) continue;
      if (const Spring& whole = network.springs[s]; !p.spring || power_of_two(sharing[s]))
        p.spring = {p.a, p.b, whole.stiffness / sharing[s], whole.rest_length};
    }
  for (const Hexahedron& cell : network.cells.corners)
    for (const CornerPair& p : pairs) {
      const int s = find_spring(network, cell[p.a], cell[p.b]);
      if ((s >= 0) != p.spring.has_value()) return {};
      if (s < 0) continue;
      const Spring& whole = network.springs[s];
      if (!(std::abs(whole.stiffness - sharing[s] * p.spring->stiffness) <= equal * whole.stiffness)) return {};
      if (!(std::abs(whole.rest_length - p.spring->rest_length) <= equal * whole.rest_length)) return {};
    }
  std::vector<Spring> springs;
  for (const CornerPair& p : pairs)
    if (p.spring) springs.push_back(*p.spring);
  return springs;
}

}  // namespace

void recognise_lattice(Network& network) {
  network.cells.grid.reset();
  network.cells.springs.clear();
  Mesh mesh;
  mesh.nodes = network.X;
  mesh.hexahedra = network.cells.corners;
  const std::optional<Grid> grid = detect_grid(mesh);
  const Vec3 edges = network.cells.edge * network.cells.proportions;
  if (!grid || ((grid->spacing - edges).array().abs() > 1e-6 * edges.array()).any()) return;
  double points = 1;  // kernels of lattices have a place for each
  for (const int n : grid->cells) points *= n + 1;
  if (points > most_points_per_node * network.nodes()) return;
  const Eigen::VectorXd volume = nodal_volumes(mesh);
  if (((network.volume - volume).array().abs() > equal * volume.array()).any()) return;
  auto springs = springs_of_cell(network);
  if (!springs) return;
  network.cells.grid = grid;
  network.cells.springs = std::move(*springs);
}

}  // namespace springproof
