#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "msm/parameters/calibrate.h"
#include "msm/topology/lattices_without_cells.h"
#include "support/tolerances.h"
#include "support/zoo.h"

namespace springproof::planar_and_node_lattice_test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Kot et al. (2014), Fig. 13: beam 4 x 1 x 1, 18-spring pattern.
TEST(NodeLattice, HasTheCountsOfKotFigure13) {
  const Network coarse = node_lattice(block_mesh({4, 1, 1}, {8, 2, 2}), isotropic_pattern(infinity));
  EXPECT_EQ(coarse.nodes(), 32);
  EXPECT_EQ(coarse.springs.size(), 132u);
  const Network fine = node_lattice(block_mesh({4, 1, 1}, {16, 4, 4}), isotropic_pattern(infinity));
  EXPECT_EQ(fine.nodes(), 256);
  EXPECT_EQ(fine.springs.size(), 1632u);
}

TEST(NodeLattice, NodesAreCellsWithTheirVolumeAndFullSprings) {
  const Mesh mesh = test::notched_block(0.5);
  const Network network = node_lattice(mesh, isotropic_pattern(2));
  ASSERT_EQ(network.nodes(), int(mesh.hexahedra.size()));
  for (int c = 0; c < network.nodes(); ++c) {
    Vec3 centre = Vec3::Zero();
    for (const int n : mesh.hexahedra[c]) centre += mesh.nodes.row(n).transpose() / 8;
    EXPECT_LT((network.X.row(c).transpose() - centre).norm(), 1e-14);
  }
  EXPECT_NEAR(network.volume.sum(), 10 * 0.125, 1e-14);
  const CubicPattern pattern = isotropic_pattern(2);
  for (const Spring& s : network.springs) {
    const double axes = std::pow(s.rest_length / 0.5, 2);
    EXPECT_EQ(s.stiffness, axes < 1.5 ? pattern.k_e : axes < 2.5 ? pattern.k_f : pattern.k_c);
    EXPECT_NEAR((network.X.row(s.i) - network.X.row(s.j)).norm(), s.rest_length, 1e-14);
  }
}

// A large lattice tends to the infinite one, k = E a / 2.5 (Kot, eq. 15); a small one lacks springs and must be scaled
// up.
TEST(NodeLattice, CalibrationMakesUpForTheMissingSurface) {
  Network beam = node_lattice(block_mesh({4, 1, 1}, {8, 2, 2}), isotropic_pattern(infinity));
  calibrate(0.4, beam);  // E = 1 at nu = 1/4
  EXPECT_NEAR(affine_shear_modulus(beam), 0.4, test::round_off);
  // 8 x 2 x 2: 60 edges, 72 diagonals, V = 4, a = 1/2: E = (60 + 144) k a^2 / (6 V).
  EXPECT_NEAR(beam.springs.front().stiffness, 24.0 / (204 * 0.25), test::round_off);
  EXPECT_THROW(node_lattice(block_mesh({1, 1, 2}, {2, 2, 2}), isotropic_pattern(2)), std::invalid_argument);
}

// A square plate: turned by 0 or 90 degrees the lattice is the one that is not turned.
TEST(NodeLattice, FillsARegionTurned) {
  const Mesh plate = block_mesh({8, 8, 2}, {8, 8, 2});
  const Region region = region_of(plate);
  const Network aligned = node_lattice(plate, isotropic_pattern(infinity));
  for (const double angle : {0.0, std::numbers::pi / 2}) {
    const Network turned = node_lattice(region, 1, angle, isotropic_pattern(infinity));
    EXPECT_EQ(turned.nodes(), aligned.nodes());
    EXPECT_EQ(turned.springs.size(), aligned.springs.size());
    EXPECT_NEAR((turned.X.colwise().sum() - aligned.X.colwise().sum()).norm(), 0, 1e-9);
  }
  const Network turned = node_lattice(region, 1, std::numbers::pi / 4, isotropic_pattern(infinity));
  EXPECT_NEAR(turned.nodes(), 128, 12);
  for (Eigen::Index n = 0; n < turned.X.rows(); ++n) EXPECT_TRUE(region.inside(turned.X.row(n).transpose()));
  for (const Spring& s : turned.springs) {
    const Eigen::RowVector3d d = turned.X.row(s.j) - turned.X.row(s.i);
    EXPECT_NEAR(d.norm(), s.rest_length, 1e-12);
    if (d[2] == 0 && s.rest_length < 1.1) {
      EXPECT_NEAR(std::abs(d[0]), std::sqrt(0.5), 1e-12);  // edges: diagonal now
    }
  }
  Region nowhere = region;
  nowhere.inside = [](const Vec3&) { return false; };
  EXPECT_THROW(node_lattice(nowhere, 1, 0.1, isotropic_pattern(infinity)), std::invalid_argument);
}

TEST(HexagonalLattice, HasTheModuliOfKotEquation12) {
  const Network network = hexagonal_lattice(block_mesh({3, 2, 0.1}, {3, 2, 1}), 0.23);
  const double area = network.volume.sum() / 0.1;
  const double modulus = 3 / (4 * std::sqrt(3.0));  // lambda = mu = 3 k / (4 sqrt 3) for k = 1, in-plane
  for (const Eigen::Vector3d& e : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(0.3, -0.7, 0.4)}) {
    double energy = 0;
    for (const Spring& s : network.springs) {
      const Vec3 d = (network.X.row(s.j) - network.X.row(s.i)).transpose();
      const double stretch = (e[0] * d[0] * d[0] + e[1] * d[1] * d[1] + 2 * e[2] * d[0] * d[1]) / s.rest_length;
      energy += s.stiffness * stretch * stretch / 2;
    }
    const double trace = e[0] + e[1], square = e[0] * e[0] + e[1] * e[1] + 2 * e[2] * e[2];
    EXPECT_NEAR(energy / (area * modulus * (trace * trace / 2 + square)), 1, test::round_off);
  }
  EXPECT_NEAR(affine_shear_modulus(network) * 0.1 / modulus, 1, test::round_off);  // d = 2
}

TEST(HexagonalLattice, FillsTheRectangleByWholeRows) {
  for (const double edge : {0.05, 0.11, 0.3, 5.0}) {
    const Network network = hexagonal_lattice(block_mesh({3, 2, 0.1}, {3, 2, 1}), edge);
    const double a = network.cells.edge;
    EXPECT_NEAR(network.X.col(1).minCoeff(), 0, 1e-14);
    EXPECT_NEAR(network.X.col(1).maxCoeff(), 2, 1e-12);
    EXPECT_NEAR(network.volume.sum() / 0.2, 3, a / 2 + 1e-12);
    EXPECT_NEAR(network.X.col(0).mean(), 1.5, 1e-10);
    std::set<std::array<int, 2>> sides;
    for (const auto& t : network.triangles) {
      const Vec3 u = (network.X.row(t[1]) - network.X.row(t[0])).transpose(),
                 v = (network.X.row(t[2]) - network.X.row(t[0])).transpose();
      EXPECT_NEAR((u[0] * v[1] - u[1] * v[0]) / (a * a * std::sqrt(3.0) / 2), 1, 1e-10);  // anticlockwise, equilateral
      EXPECT_NEAR(u.norm() / a, 1, 1e-10);
      for (int c = 0; c < 3; ++c) sides.insert({std::min(t[c], t[(c + 1) % 3]), std::max(t[c], t[(c + 1) % 3])});
    }
    EXPECT_EQ(sides.size(), network.springs.size());
    EXPECT_GT(network.volume.minCoeff(), 0);
    // Euler: one connected disc
    EXPECT_EQ(network.nodes() - int(network.springs.size()) + int(network.triangles.size()), 1);
  }
  EXPECT_THROW(hexagonal_lattice(block_mesh({3, 2, 1}, {1, 1, 1}), 0), std::invalid_argument);
  EXPECT_THROW(hexagonal_lattice(block_mesh({3, 2, 1}, {1, 1, 1}), 1e-5), std::invalid_argument);
}

}  // namespace
}  // namespace springproof::planar_and_node_lattice_test
