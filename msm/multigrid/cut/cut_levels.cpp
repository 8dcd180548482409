#include "msm/multigrid/cut/cut_levels.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "meshes/united_numbers.h"
#include "msm/algebra/fixed.h"

namespace springproof {
namespace {

constexpr std::size_t smallest_cut_level = 300;  // points

// Stiffness of bonds over that on the finer level.  Many bonds of a coarse cell hold it like glue: with their full
// stiffness a stiff part in soft cells turns all of the cells at it, and its rotations see levels three to ten times
// too stiff.
constexpr double softer_bonds = 0.25;

/// The smallest cubes become their parents; others stay.  In edges of the coarser level.
LatticeCube parent_of(const LatticeCube& c) {
  return {{c.at[0] >> 1, c.at[1] >> 1, c.at[2] >> 1}, std::max(1, c.size / 2)};
}

/// Trilinear weight of corner n of a cube at a place in half edges.
double weight_at(const LatticeCube& cube, int n, const std::array<int, 3>& place) {
  const std::array<int, 3> corner = cube.corner(n);
  double w = 1;
  for (int d = 0; d < 3; ++d) w *= std::max(0.0, 1 - std::abs(place[d] - 2.0 * corner[d]) / (2 * cube.size));
  return w;
}

/// Moments about the middle of a cube, in its edges: volume, first, second.
struct ChildMoments {
  double volume = 0;
  Vec3 first = Vec3::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();

  void add_child(const FilledPart& part, const std::array<int, 3>& child) {
    const double v = part.fraction / 8;
    const Vec3 o(child[0] & 1 ? 0.25 : -0.25, child[1] & 1 ? 0.25 : -0.25, child[2] & 1 ? 0.25 : -0.25);
    const Eigen::Matrix3d own = second_moments(part);
    volume += v;
    first += v * (part.mean / 2 + o);
    second += v * (own / 4 + o * part.mean.transpose() / 2 + part.mean * o.transpose() / 2 + o * o.transpose());
  }
};

/// Cells of a level at each of its points.
std::vector<std::vector<int>> cells_at_points(const CutLevel& level) {
  std::vector<std::vector<int>> at(level.point.size());
  for (std::size_t c = 0; c < level.corners.size(); ++c)
    for (const int p : level.corners[c]) at[p].push_back(static_cast<int>(c));
  return at;
}

/// Pairs of cells that share a point, or of which one carries a point of the other.
std::vector<std::array<int, 2>> neighbours(const CutLevel& level, const std::vector<std::vector<int>>& at_point) {
  std::vector<std::array<int, 2>> pairs;
  for (const std::vector<int>& cells : at_point)
    for (const int c : cells)
      if (c != cells.front()) pairs.push_back({c, cells.front()});
  for (const CarriedPoint& p : level.carried)
    for (const int carrier : at_point[p.by.front()]) {
      const Hexahedron& all = level.corners[carrier];
      if (std::all_of(p.by.begin(), p.by.end(),
                      [&](int q) { return std::find(all.begin(), all.end(), q) != all.end(); }))
        for (const int c : at_point[p.point]) pairs.push_back({c, carrier});
    }
  return pairs;
}

/// Cells of a level that become one: children of one cube and material that share points.
UnitedNumbers families(const CutLevel& fine, const std::vector<std::vector<int>>& at_point) {
  UnitedNumbers family(fine.cubes.size());
  const auto are_siblings = [&](const LatticeCube& a, const LatticeCube& b) {
    return a.size == 1 && b.size == 1 && parent_of(a).at == parent_of(b).at;
  };
  for (const std::vector<int>& cells : at_point)
    for (const int c : cells)
      for (const int d : cells)
        if (d < c && are_siblings(fine.cubes[c], fine.cubes[d]) && fine.material(c) == fine.material(d))
          family.unite(c, d);
  return family;
}

/// Sets the parents of a level's cells, and the cubes of the coarser level with what the body fills of them.
void add_parents(UnitedNumbers family, CutLevel& fine, CutLevel& coarse) {
  std::vector<int>& parent = fine.parent;
  parent.assign(fine.cubes.size(), -1);
  std::vector<ChildMoments> moments;
  for (std::size_t c = 0; c < fine.cubes.size(); ++c) {
    const int head = family.of(static_cast<int>(c));
    if (parent[head] < 0) {
      parent[head] = static_cast<int>(coarse.cubes.size());
      coarse.cubes.push_back(parent_of(fine.cubes[c]));
      coarse.filled.push_back(fine.filled[c]);
      if (!fine.materials.empty()) coarse.materials.push_back(fine.materials[c]);
      moments.emplace_back();
    }
    parent[c] = parent[head];
    if (fine.cubes[c].size == 1) moments[parent[c]].add_child(fine.filled[c], fine.cubes[c].at);
  }
  for (std::size_t c = 0; c < moments.size(); ++c)
    if (const ChildMoments& m = moments[c]; m.volume > 0) coarse.filled[c] = filled_part(m.volume, m.first, m.second);
}

/// How the points of a level follow those of the coarser one.
void set_weights(const std::vector<std::vector<int>>& at_point, const CutLevel& coarse, CutLevel& fine) {
  const auto points = static_cast<Eigen::Index>(fine.point.size());
  fine.weights.resize(points, static_cast<Eigen::Index>(coarse.point.size()));
  fine.weights.reserve(Eigen::VectorXi::Constant(points, 8));
  for (std::size_t p = 0; p < fine.point.size(); ++p) {
    const int c = fine.parent[at_point[p].front()];
    for (int n = 0; n < 8; ++n) {
      const double w = weight_at(coarse.cubes[c], n, fine.point[p]);
      if (w > 0) fine.weights.insert(static_cast<Eigen::Index>(p), coarse.corners[c][n]) = static_cast<float>(w);
    }
  }
  fine.weights.makeCompressed();
}

/// A mean over the corners of a cell of a level as one over those of its parent.
struct MeanAbove {
  Hexahedron corners;
  std::array<double, 8> weights{};

  MeanAbove(const Hexahedron& of, const std::array<double, 8>& mean, const std::vector<std::vector<int>>& at_point,
            const CutLevel& fine, const CutLevel& coarse) {
    int cell = -1;
    for (const int c : at_point[of[0]])
      if (fine.corners[c] == of) cell = c;
    const int up = fine.parent[cell];
    corners = coarse.corners[up];
    for (int n = 0; n < 8; ++n)
      for (int m = 0; m < 8; ++m) weights[m] += mean[n] * weight_at(coarse.cubes[up], m, fine.point[of[n]]);
  }
};

/// The anchors and bonds of a level, on the corners of the parents.
void add_anchors(const std::vector<std::vector<int>>& at_point, const CutLevel& fine, CutLevel& coarse) {
  for (const Anchor& a : fine.anchors) {
    const MeanAbove above(a.corners, a.weights, at_point, fine, coarse);
    coarse.anchors.push_back({above.corners, above.weights, a.node, a.stiffness});
  }
  for (const InterfaceBond& b : fine.bonds) {
    const MeanAbove first(b.corners[0], b.weights[0], at_point, fine, coarse),
        second(b.corners[1], b.weights[1], at_point, fine, coarse);
    coarse.bonds.push_back(
        {{first.corners, second.corners}, {first.weights, second.weights}, softer_bonds * b.stiffness});
  }
}

/// The cells of twice the edge: children of one cube that share points are one cell, and cells whose children share
/// points share their corners.
CutLevel coarsen(CutLevel& fine) {
  const auto at_point = cells_at_points(fine);
  CutLevel coarse;
  coarse.edge = 2 * fine.edge;
  add_parents(families(fine, at_point), fine, coarse);
  std::vector<std::array<int, 2>> links;
  for (const auto& [c, d] : neighbours(fine, at_point))
    if (fine.parent[c] != fine.parent[d]) links.push_back({fine.parent[c], fine.parent[d]});
  JoinedCubes joined = join_cubes(coarse.cubes, links);
  coarse.corners = std::move(joined.corners);
  coarse.point = std::move(joined.points);
  coarse.carried = std::move(joined.carried);
  set_weights(at_point, coarse, fine);
  add_anchors(at_point, fine, coarse);
  return coarse;
}

/// Corners that supports hold themselves, as in whole cubes, as anchors of a level's cells: coarser levels have none
/// there.  30 E A/l, A = l^2, E = 5/2 G.
std::vector<Anchor> held_corners(const CutLevel& level, const AnchoredNodes& nodes, const AveragedSprings& law) {
  std::vector<Anchor> held;
  const auto at_point = cells_at_points(level);
  for (int p = 0; p < nodes.corners; ++p) {
    Anchor a{level.corners[at_point[p].front()], {}, -1, Eigen::Matrix3d::Zero()};
    for (int n = 0; n < 8; ++n) a.weights[n] = a.corners[n] == p;
    double G = 0;
    for (const int c : at_point[p]) G = std::max(G, law.in(level.material(c)).shear_modulus);
    for (int d = 0; d < 3; ++d)
      if (nodes.fixed[3 * p + d]) a.stiffness(d, d) = 75 * G * level.edge;
    if (a.stiffness.trace() > 0) held.push_back(a);
  }
  return held;
}

}  // namespace

std::vector<std::vector<int>> CutLevel::anchored_points() const {
  std::vector<std::vector<int>> all;
  const Carriers carriers = carriers_of(static_cast<int>(point.size()), carried);
  for (const Anchor& a : anchors) {
    std::vector<int>& points = all.emplace_back();
    for (const int n : a.corners) for_each_carrier(carriers, n, [&](int p, double) { points.push_back(p); });
  }
  for (const InterfaceBond& b : bonds) {
    std::vector<int>& points = all.emplace_back();
    for_each_corner(b,
                    [&](int n, double) { for_each_carrier(carriers, n, [&](int p, double) { points.push_back(p); }); });
  }
  for (std::vector<int>& points : all) {
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
  }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

Eigen::MatrixXd CutLevel::dense(const std::vector<int>& points) const {
  const auto size = static_cast<Eigen::Index>(points.size());
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(3 * size, 3 * size);
  for (Eigen::Index m = 0; m < size; ++m)
    for (Eigen::Index n = 0; n < size; ++n) {
      const float* block = A.block(points[m], points[n]);
      if (!block) continue;
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) K(3 * m + a, 3 * n + b) = block[3 * a + b];
    }
  for (Eigen::Index i = 0; i < K.rows(); ++i)
    if (K(i, i) == 0) K(i, i) = 1e30;  // fixed
  return K;
}

void CutLevel::invert_anchored() {
  anchored = anchored_points();
  anchored_inverse.clear();
  for (const std::vector<int>& points : anchored) anchored_inverse.push_back(dense(points).inverse().cast<float>());
}

void CutLevel::relax_anchored(std::size_t c, const float* b, float* x) const {
  const std::vector<int>& points = anchored[c];
  Eigen::VectorXf r(3 * static_cast<Eigen::Index>(points.size()));
  for (std::size_t n = 0; n < points.size(); ++n) A.residual(b, x, points[n], r.data() + 3 * n);
  const Eigen::VectorXf d = anchored_inverse[c] * r;
  for (std::size_t n = 0; n < points.size(); ++n)
    for (int a = 0; a < 3; ++a) x[3 * points[n] + a] += d[static_cast<Eigen::Index>(3 * n) + a];
}

void CutLevel::restrict_to(const Eigen::VectorXf& r, const CutLevel& next, Eigen::VectorXf& out) const {
  by_point(out).noalias() += weights.transpose() * by_point(r);
  hand_back(next.carried, out);
}

void CutLevel::prolongate(Eigen::VectorXf& coarse, const CutLevel& next, Eigen::VectorXf& u) const {
  carry(next.carried, coarse);
  by_point(u).noalias() += weights * by_point(coarse);
}

AnchoredNodes::AnchoredNodes(const Network& network, std::vector<char> fixed_unknowns)
    : anchors(network.anchors),
      carried(network.cells.carried),
      fixed(std::move(fixed_unknowns)),
      corners(network.nodes() - static_cast<int>(network.anchors.size())) {}

bool AnchoredNodes::holds(const Anchor& anchor) const {
  bool all = true;
  for (int d = 0; d < 3; ++d) all &= !anchor.acts(d) || fixed[3 * anchor.node + d];
  return all;
}

Eigen::Matrix3d AnchoredNodes::inverse_of_free(const Anchor& anchor) const {
  Eigen::Matrix3d free = Eigen::Matrix3d::Zero();
  for (int d = 0; d < 3; ++d) free(d, d) = anchor.acts(d) && !fixed[3 * anchor.node + d];
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  return free * Eigen::Matrix3d(free * anchor.stiffness * free + I - free).inverse() * free;
}

StiffnessOfCells averaged_cells(const AveragedSprings& law, const CutLevel& level) {
  return {[&](std::size_t c) { return law.cell_matrix(level.shape(c)); }, true};
}

std::vector<char> AnchoredNodes::fixed_corners() const {
  std::vector<char> corner = unknowns_of_corners(), own = corner;
  for (const CarriedPoint& p : carried) std::fill_n(own.begin() + 3 * p.point, 3, 0);
  if (std::count(own.begin(), own.end(), 0) == 3 * corners) return {};
  return corner;
}

Eigen::VectorXd AnchoredNodes::eliminated(const Eigen::VectorXd& r) const {
  Eigen::VectorXd b = r.head(3 * corners);
  for (const Anchor& a : anchors) {  // K (u_node - sum w u) = r_node
    if (holds(a)) continue;
    const Vec3 force = a.stiffness * inverse_of_free(a) * r.segment<3>(3 * a.node);
    for (int n = 0; n < 8; ++n) b.segment<3>(3 * a.corners[n]) += a.weights[n] * force;
  }
  hand_back(carried, b);
  for (int i = 0; i < 3 * corners; ++i)
    if (fixed[i]) b[i] = 0;
  return b;
}

void AnchoredNodes::multiply(const CutMatrix<double>& of_cells, double unit, const Eigen::VectorXd& x,
                             Eigen::VectorXd& y) const {
  y.setZero(x.size());
  of_cells.multiply(x.data(), y.data());
  y *= unit;
  if (anchors.empty()) return;
  Eigen::VectorXd u = x, f = Eigen::VectorXd::Zero(carried.empty() ? 0 : x.size());
  carry(carried, u);
  Eigen::VectorXd& on_corners = carried.empty() ? y : f;
  for (const Anchor& a : anchors) {
    Vec3 stretch = -u.segment<3>(3 * a.node);
    for (int n = 0; n < 8; ++n) stretch += a.weights[n] * u.segment<3>(3 * a.corners[n]);
    const Vec3 force = a.stiffness * stretch;
    y.segment<3>(3 * a.node) -= force;
    for (int n = 0; n < 8; ++n) on_corners.segment<3>(3 * a.corners[n]) += a.weights[n] * force;
  }
  if (carried.empty()) return;
  hand_back(carried, f);
  y += f;
}

void AnchoredNodes::complete(const Eigen::VectorXd& r, const Eigen::VectorXd& of_corners, Eigen::VectorXd& z) const {
  z.setZero(r.size());
  z.head(3 * corners) = of_corners;
  carry(carried, z);
  for (const Anchor& a : anchors) {
    if (holds(a)) continue;
    Vec3 mean = Vec3::Zero();
    for (int n = 0; n < 8; ++n) mean += a.weights[n] * z.segment<3>(3 * a.corners[n]);
    z.segment<3>(3 * a.node) = inverse_of_free(a) * (r.segment<3>(3 * a.node) + a.stiffness * mean);
  }
  for (const CarriedPoint& c : carried) z.segment<3>(3 * c.point).setZero();
}

std::vector<CutLevel> cut_levels(const Network& network, const AnchoredNodes& nodes, const AveragedSprings* law) {
  CutLevel finest;
  finest.edge = network.cells.edge;
  finest.corners = network.cells.corners;
  finest.filled = network.cells.filled;
  finest.filled.resize(network.cells.size());  // whole cubes have none
  finest.materials = network.cells.materials;
  finest.bonds = network.bonds;
  const Vec3 lower = network.X.topRows(nodes.corners).colwise().minCoeff().transpose();
  for (int n = 0; n < nodes.corners; ++n) {
    std::array<int, 3> at;
    for (int d = 0; d < 3; ++d)
      at[d] = static_cast<int>(
          std::lround((network.X(n, d) - lower[d]) / (network.cells.edge * network.cells.proportions[d])));
    finest.point.push_back(at);
  }
  for (std::size_t c = 0; c < network.cells.size(); ++c)
    finest.cubes.push_back({finest.point[network.cells.corners[c][0]],
                            static_cast<int>(std::lround(network.cells.edge_of(c) / network.cells.edge))});
  finest.carried = network.cells.carried;
  for (const Anchor& a : nodes.anchors) {
    const Eigen::Matrix3d inverse = nodes.inverse_of_free(a);
    if ((inverse.diagonal().array() > 0).all()) continue;  // nothing holds its node
    finest.anchors.push_back({a.corners, a.weights, a.node, a.stiffness - a.stiffness * inverse * a.stiffness});
  }
  const std::size_t anchors = finest.anchors.size();
  if (law && network.anchors.empty() && network.cells.carried.empty()) {
    const std::vector<Anchor> held = held_corners(finest, nodes, *law);
    finest.anchors.insert(finest.anchors.end(), held.begin(), held.end());
  }
  std::vector<CutLevel> levels = {std::move(finest)};
  while (levels.back().point.size() > smallest_cut_level && levels.back().cubes.size() > 8) {
    CutLevel coarse = coarsen(levels.back());
    levels.push_back(std::move(coarse));
  }
  levels.front().anchors.resize(anchors);
  return levels;
}

void take_matrix(const CutMatrix<double>& of_cells, double unit, const std::vector<char>& fixed, CutLevel& level) {
  level.A = CutMatrix<float>(of_cells);
  level.A.add_anchors(level, unit);
  level.A.clear_fixed(fixed);
  level.D = level.A.inverse_diagonal(fixed);
}

void CoarsestFactors::factor(const Eigen::SparseMatrix<double>& K) {
  // In single precision rigid motions of a level without supports are nearly singular, and fixed unknowns of the finest
  // level, if it is the coarsest, have empty rows.
  const double mean = K.diagonal().mean();
  Eigen::SparseMatrix<double> I(K.rows(), K.cols());
  I.setIdentity();
  for (const double shift : {1e-7, 1e-3}) {
    ldlt_.compute(K + shift * mean * I);
    if (ldlt_.info() == Eigen::Success && ldlt_.vectorD().minCoeff() > 0.1 * shift * mean) return;
  }
  if (ldlt_.info() != Eigen::Success || !(ldlt_.vectorD().minCoeff() > 0))
    throw std::runtime_error("the coarsest lattice is not positive definite");
}

Eigen::VectorXf CoarsestFactors::solve(const Eigen::VectorXf& b) const {
  return ldlt_.solve(b.cast<double>().eval()).cast<float>();
}

}  // namespace springproof
