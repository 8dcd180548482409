#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "msm/topology/random/repair.h"

namespace springproof::repair_test {
namespace {

std::vector<Vec3> cube_lattice(int n) {
  std::vector<Vec3> points;
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) points.emplace_back(i, j, k);
  return points;
}

std::vector<Bond> join(const std::vector<Vec3>& points, double reach) {
  std::vector<Bond> bonds;
  for (int i = 0; i < int(points.size()); ++i)
    for (int j = i + 1; j < int(points.size()); ++j)
      if ((points[i] - points[j]).norm() < reach) bonds.push_back({i, j, {}});
  return bonds;
}

TEST(Repair, LeavesASoundNetworkAlone) {
  std::vector<Vec3> points = cube_lattice(4);
  std::vector<Bond> bonds = join(points, 1.5);
  const auto before = bonds.size();
  const NetworkRepair counts = repair(points, bonds, Vec3::Zero());
  EXPECT_EQ(counts.floppy_nodes + counts.detached_nodes, 0);
  EXPECT_EQ(bonds.size(), before);
}

TEST(Repair, RemovesTailsFlatNodesAndTheSmallerPart) {
  std::vector<Vec3> points = cube_lattice(4);
  std::vector<Bond> bonds = join(points, 1.5);
  const int n = int(points.size());
  // A chain of two: the second falls first, then the one that carried it.
  points.insert(points.begin(), {Vec3(-1, 0, 0), Vec3(-2, 0, 0)});
  for (Bond& b : bonds) b = {b.i + 2, b.j + 2, {}};
  bonds.push_back({0, 2, {}});
  bonds.push_back({0, 1, {}});
  for (const int j : {3, 6, 18}) bonds.push_back({0, j, {}});  // the first has five springs: enough without the second
  // Five springs, all nearly in one plane.
  points.push_back({1.5, 1.5, 0.02});
  const int flat = int(points.size()) - 1;
  for (int p = 2; p < n + 2; ++p)
    if (points[p].z() == 0 && (points[p] - points[flat]).norm() < 1.7) bonds.push_back({p, flat, {}});
  // A part of its own.
  for (const Vec3& p : cube_lattice(3)) points.push_back(p + Vec3(20, 0, 0));
  for (const Bond& b : join(cube_lattice(3), 1.5)) bonds.push_back({b.i + flat + 1, b.j + flat + 1, {}});

  const NetworkRepair counts = repair(points, bonds, Vec3::Zero());
  EXPECT_EQ(counts.floppy_nodes, 2);  // the tail's end and the flat node
  EXPECT_EQ(counts.detached_nodes, 27);
  EXPECT_EQ(points.size(), 65u);
  EXPECT_EQ(points.front(), Vec3(-1, 0, 0));
  for (const Bond& b : bonds) {
    EXPECT_LT(b.j, 65);
    EXPECT_LT((points[b.i] - points[b.j]).norm(), 2.1);
  }
}

TEST(Repair, WhatStaysHasWellSpreadSprings) {
  RandomParameters p{};
  p.spacing = 1;
  p.springs_per_node = 9;
  p.surface_nodes = false;
  NetworkRepair counts;
  const Network network = random_network(region_of(block_mesh({12, 12, 12}, {1, 1, 1})), p, &counts);
  EXPECT_GT(counts.floppy_nodes, 10);
  std::vector<Eigen::Matrix3d> sum(network.nodes(), Eigen::Matrix3d::Zero());
  std::vector<int> springs(network.nodes(), 0);
  for (const Spring& s : network.springs) {
    const Vec3 n = (network.X.row(s.j) - network.X.row(s.i)).transpose() / s.rest_length;
    for (const int end : {s.i, s.j}) {
      sum[end] += n * n.transpose();
      ++springs[end];
    }
  }
  for (int n = 0; n < network.nodes(); ++n) {
    EXPECT_GE(springs[n], 4);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(sum[n]);
    EXPECT_GE(solver.eigenvalues()[0], 0.05 * sum[n].trace() / 3 - 1e-12);
  }
}

}  // namespace
}  // namespace springproof::repair_test
