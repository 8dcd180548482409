#include <gtest/gtest.h>

#include <limits>

#include "msm/parameters/calibrate.h"
#include "msm/topology/cubic_lattice.h"
#include "support/tolerances.h"
#include "support/zoo.h"

namespace springproof::lattice_test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Golec et al. (2019), eq. (5.12), the forms in G.
CubicPattern golec_5_12(double A, double G, double l) {
  const double k_c = 3 * G * l / (4 + 3 * A);
  return {G * l * (8 + 3 * A) / (4 + 3 * A), A * k_c, k_c};
}

double spring_between(const Network& network, const Vec3& a, const Vec3& b) {
  for (const Spring& s : network.springs) {
    const Vec3 p = network.X.row(s.i), q = network.X.row(s.j);
    if ((p - a).norm() + (q - b).norm() < 1e-9 || (p - b).norm() + (q - a).norm() < 1e-9) return s.stiffness;
  }
  return 0;
}

TEST(CubicLattice, CalibrationReproducesGolecEquation512) {
  const double G = 3200, l = 0.25;
  for (double A : {0.25, 1.0, 2.0, 7.0}) {
    Network network = cubic_lattice(block_mesh(l * Vec3(4, 4, 4), {4, 4, 4}), isotropic_pattern(A));
    calibrate(G, network);
    const CubicPattern expected = golec_5_12(A, G, l);
    const Vec3 centre = l * Vec3(2, 2, 2);
    EXPECT_NEAR(spring_between(network, centre, centre + l * Vec3(1, 0, 0)) / expected.k_e, 1, test::round_off);
    EXPECT_NEAR(spring_between(network, centre, centre + l * Vec3(1, 1, 0)) / expected.k_f, 1, test::round_off);
    EXPECT_NEAR(spring_between(network, centre, centre + l * Vec3(1, -1, 1)) / expected.k_c, 1, test::round_off);
    // Shared springs merged: a boundary edge has a quarter, an edge in a face a half, a surface diagonal a half.
    EXPECT_NEAR(spring_between(network, Vec3(0, 0, 0), l * Vec3(1, 0, 0)) / expected.k_e, 0.25, test::round_off);
    EXPECT_NEAR(spring_between(network, l * Vec3(1, 1, 0), l * Vec3(2, 1, 0)) / expected.k_e, 0.5, test::round_off);
    EXPECT_NEAR(spring_between(network, Vec3(0, 0, 0), l * Vec3(1, 1, 0)) / expected.k_f, 0.5, test::round_off);
  }
}

TEST(CubicLattice, CountsEachSpringOnce) {
  // n^3 cells: 3 n (n+1)^2 edges, 6 n^2 (n+1) face diagonals, 4 n^3 cube diagonals.
  const auto count = [](double A) {
    return cubic_lattice(block_mesh({1, 1, 1}, {10, 10, 10}), isotropic_pattern(A)).springs.size();
  };
  EXPECT_EQ(count(0), 3630u + 4000u);  // "no FD" of Golec et al. (2019), Table 6: 7630
  EXPECT_EQ(count(1), 3630u + 6600u + 4000u);
  EXPECT_EQ(count(infinity), 3630u + 6600u);
}

TEST(CubicLattice, MassIsDensityTimesVolume) {
  const Network network = cubic_lattice(test::notched_block(0.5), isotropic_pattern(2));
  EXPECT_NEAR(masses(network, 1200).sum(), 1200 * 10 * 0.125, 1e-9);
  EXPECT_NEAR(masses(network, 1200).minCoeff(), 1200 * 0.125 / 8, 1e-9);
}

TEST(CubicLattice, RefusesWhatIsNotCubes) {
  EXPECT_THROW(cubic_lattice(block_mesh({1, 1, 2}, {2, 2, 2}), isotropic_pattern(2)), std::invalid_argument);
  EXPECT_THROW(isotropic_pattern(-1), std::invalid_argument);
  EXPECT_THROW(isotropic_pattern(std::nan("")), std::invalid_argument);
}

TEST(Models, TableNamesAreUniqueAndResolvable) {
  std::vector<std::string> names = test::model_names();
  std::sort(names.begin(), names.end());
  EXPECT_EQ(std::adjacent_find(names.begin(), names.end()), names.end());
  for (const auto& name : names) EXPECT_EQ(test::model(name).row.name, name);
}

TEST(Models, RefuseUnknownNamesAndOptions) {
  EXPECT_THROW(resolve({"hybms", {}, "", {}}), InputError);
  EXPECT_THROW(resolve({"hybmss", {{"face_to_cub", 1.0}}, "", {}}), InputError);
  EXPECT_THROW(resolve({"hybmss", {{"face_to_cube", -1.0}}, "", {}}), InputError);
  EXPECT_THROW(resolve({"hybmss_fd", {{"face_to_cube", 1.0}}, "", {}}), InputError);
  EXPECT_THROW(resolve({"hybmss", {{"volume_energy", std::string("log")}}, "", {}}), InputError);
}

TEST(Cells, SayWhatTheyAre) {
  EXPECT_EQ(Network{}.cells.kind(), CellKind::none);
  EXPECT_EQ(lattice_without_springs(test::notched_block()).cells.kind(), CellKind::cubes);
  EXPECT_EQ(lattice_without_springs(test::notched_block(Vec3(0.5, 0.9, 0.35))).cells.kind(), CellKind::boxes);
  EXPECT_EQ(test::cut_network().cells.kind(), CellKind::cut);
  EXPECT_EQ(test::refined_network().cells.kind(), CellKind::sizes);
}

TEST(Cells, KeepTheirShapesInAPart) {
  const CellSet all = test::refined_network().cells;
  const std::vector<int> numbers = {static_cast<int>(all.size()) - 1, 0};
  const CellSet some = all.of(numbers);
  ASSERT_EQ(some.size(), numbers.size());
  for (std::size_t c = 0; c < some.size(); ++c) {
    EXPECT_EQ(some.corners[c], all.corners[numbers[c]]);
    EXPECT_EQ(some.shape(c).edge, all.shape(numbers[c]).edge);
    EXPECT_EQ(some.shape(c).volume(), all.shape(numbers[c]).volume());
  }
  EXPECT_EQ(some.kind(), all.kind());
}

}  // namespace
}  // namespace springproof::lattice_test
