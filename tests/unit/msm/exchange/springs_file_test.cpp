// Springs files: written and read back, of every model of the table.
#include "msm/exchange/springs_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <random>

#include "msm/dynamics/time_step.h"
#include "msm/exchange/springs_document.h"
#include "msm/laws/capabilities.h"
#include "msm/multigrid/cell_stiffness.h"
#include "problem/system/input_error.h"
#include "support/zoo.h"

namespace springproof::springs_file_test {
namespace {

const IsotropicMaterial material{1e4, 0.4, 1100};

Mesh mesh_of(const ModelRow& row) {
  if (row.topology == Topology::cells) return test::notched_block();
  if (row.topology == Topology::hexagonal) return block_mesh({2, 2, 0.5}, {4, 4, 1});
  return block_mesh({2, 2, 2}, {4, 4, 4});
}

SpringsFile file_of(const std::string& name) {
  const ModelParameters p = test::model(name);
  EmbeddedModel built = build_embedded(p, mesh_of(p.row), material);
  SpringsFile file;
  file.density = material.density;
  file.material = material;
  file.grip = 0.25;
  file.patches = {{"some", {1, 3, 4}}};
  file.surface.vertices = built.model.network.X.topRows(4);
  file.surface.facets = {{0, 1, 2}, {1, 3, 2}};
  file.surface.weights = built.embedding.weights.topRows(4);
  file.model = std::move(built.model);
  return file;
}

std::string message_of(const std::string& text) {
  try {
    parse_springs(text, "own.json");
  } catch (const InputError& e) {
    return e.what();
  }
  return "accepted";
}

TEST(SpringsFile, IsNotWrittenWithNumbersThatNoReaderTakes) {
  SpringsFile file = file_of("msm_18");
  for (const double density : {1e30, 1e-30, 1e300}) {
    file.density = density;
    file.model.network.volume.setConstant(density > 1 ? 1e3 : 1e-3);
    try {
      springs_as_json(file);
      FAIL() << density;
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find("nodes.mass_kg of the springs file: "), std::string::npos) << e.what();
    }
  }
}

TEST(SpringsFile, IsReadAsItWasWrittenForEveryModel) {
  for (const ModelRow& row : model_table()) {
    SCOPED_TRACE(row.name);
    const SpringsFile written = file_of(row.name);
    const SpringsFile read = parse_springs(springs_as_json(written), "own.json");
    const Network &a = written.model.network, &b = read.model.network;
    EXPECT_TRUE(b.X == a.X);
    EXPECT_LT((b.volume - a.volume).cwiseAbs().maxCoeff(), 1e-15 * a.volume.maxCoeff());
    EXPECT_EQ(b.triangles, a.triangles);
    const NodalVectors x = a.X + test::noise(a.nodes(), 0.01);
    const NodalVectors ours = forces(written.model, x);
    EXPECT_LE((forces(read.model, x) - ours).cwiseAbs().maxCoeff(), 1e-12 * ours.cwiseAbs().maxCoeff());
    EXPECT_EQ(read.model.small_displacements_only, written.model.small_displacements_only);
    EXPECT_EQ(a.cells.grid.has_value(), b.cells.grid.has_value());
    EXPECT_EQ(can(written.model, Capability::equal_cells), can(read.model, Capability::equal_cells));
    const double step = safe_time_step(written.model, material.density);
    EXPECT_NEAR(safe_time_step(read.model, read.density), step, 1e-9 * step);
    ASSERT_EQ(a.cells.springs.size(), b.cells.springs.size());
    for (std::size_t s = 0; s < a.cells.springs.size(); ++s)
      EXPECT_NEAR(a.cells.springs[s].stiffness, b.cells.springs[s].stiffness, 1e-12 * a.cells.springs[s].stiffness);
    EXPECT_EQ(read.patches, written.patches);
    EXPECT_EQ(read.surface.facets, written.surface.facets);
    EXPECT_EQ(read.grip, 0.25);
  }
}

TEST(SpringsFile, OfUnequalSpringsIsNoLattice) {
  SpringsFile file = file_of("hybmss");
  const double step = safe_time_step(file.model, file.density);
  file.model.network.springs[7].stiffness *= 100;
  const SpringsFile read = parse_springs(springs_as_json(file), "own.json");
  EXPECT_FALSE(read.model.network.cells.grid);
  EXPECT_FALSE(can(read.model, Capability::equal_cells));
  EXPECT_LT(safe_time_step(read.model, file.density), step / 2);
}

TEST(SpringsFile, OfUnequalMassesIsNoLattice) {
  SpringsFile file = file_of("hybmss");
  file.model.network.volume[0] /= 1000;
  const SpringsFile read = parse_springs(springs_as_json(file), "own.json");
  EXPECT_FALSE(read.model.network.cells.grid);
  EXPECT_LT(safe_time_step(read.model, file.density), safe_time_step(file.model, 10 * file.density));
}

TEST(SpringsFile, MayHaveItsSpringsInAnyOrder) {
  for (const char* name : {"emsm", "emsm_centred"}) {
    SpringsFile file = file_of(name);
    const NodalVectors x = check_positions(file.model.network.X), ours = forces(file.model, x);
    auto& springs = file.model.network.springs;
    auto& weight = std::get<MomentumDispersion>(file.model.laws.back()).weight;
    ASSERT_EQ(weight.size(), 2 * springs.size());
    for (std::size_t s = 0; s < springs.size(); ++s) weight[2 * s] *= 1 + 1e-3 * double(s % 7);  // the ends differ
    const NodalVectors uneven = forces(file.model, x);
    for (std::size_t s = 0; s + 1 < springs.size(); s += 3) {
      std::swap(springs[s], springs[s + 1]);
      for (int end = 0; end < 2; ++end) std::swap(weight[2 * s + end], weight[2 * s + 2 + end]);
      std::swap(springs[s].i, springs[s].j);
      std::swap(weight[2 * s], weight[2 * s + 1]);
    }
    EXPECT_GT((uneven - ours).norm(), 1e-6 * ours.norm());
    const SpringsFile read = parse_springs(springs_as_json(file), "own.json");
    EXPECT_LT((forces(read.model, x) - uneven).norm(), 1e-12 * uneven.norm()) << name;
    const auto before = [](const Spring& a, const Spring& b) { return std::pair(a.i, a.j) < std::pair(b.i, b.j); };
    EXPECT_TRUE(std::is_sorted(read.model.network.springs.begin(), read.model.network.springs.end(), before));
  }
}

/// A bar of two nodes.
std::string bar(const std::string& springs, const std::string& more = "") {
  return R"({"format": "springproof springs", "version": 1, "density_kg_m3": 1000, "laws": {"springs": {}},
"nodes": {"position_m": [[0, 0, 0], [1, 0, 0]], "mass_kg": [1, 2]}, "springs": )" +
         springs + more + "}";
}
const std::string one_spring = R"({"nodes": [[1, 0]], "stiffness_N_m": [5], "rest_length_m": [1]})";

TEST(SpringsFile, NeedsNoMoreThanNodesAndSprings) {
  const SpringsFile file = parse_springs(bar(one_spring), "own.json");
  EXPECT_EQ(file.model.network.springs[0].j, 1);
  EXPECT_NEAR(masses(file.model.network, file.density)[1], 2, 1e-15);
  EXPECT_FALSE(file.material);
}

TEST(SpringsFile, IsRefusedWithItsPlace) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"{", "own.json:1:2: not valid JSON"},
      {"[1]", "own.json: /: is a list of 1 (allowed: an object)"},
      {"{}", "own.json: /: is no springs file"},
      {bar(R"({"nodes": [[0, 0]], "stiffness_N_m": [5], "rest_length_m": [1]})"),
       "/springs/nodes: number 0 names a node twice"},
      {bar(R"({"nodes": [[0, 1], [1, 0]], "stiffness_N_m": [5, 5], "rest_length_m": [1, 1]})"),
       "/springs/nodes: springs 0 and 1 connect the same nodes"},
      {bar(R"({"nodes": [[0, 1]], "stiffness_N_m": [5], "rest_length_m": []})"),
       "/springs/rest_length_m: has 0 numbers (allowed: 1, as there are springs)"},
      {bar(R"({"nodes": [[0, -1]], "stiffness_N_m": [5], "rest_length_m": [1]})"), "/springs/nodes/0/1: is -1"},
      {bar(R"({"nodes": [[0, 1]], "stiffness_N_m": ["5"], "rest_length_m": [1]})"),
       "/springs/stiffness_N_m/0: is \"5\""},
      {bar(R"({"nodes": [[0]], "stiffness_N_m": [5], "rest_length_m": [1]})"), "/springs/nodes/0: is a list of 1"},
      {bar(R"({"nodes": [], "stiffness_N_m": [], "rest_length_m": []})"), "/springs: node 0 has no spring"},
      {bar(one_spring, R"(, "cells": {"nodes": [[0, 1, 0, 1, 0, 1, 0, 1]], "edge_m": 1})"),
       "/cells/nodes: number 0 names a node twice"},
      {bar(one_spring, R"(, "patches": {"a/b": [0, 2]})"),
       "/patches/a~1b/1: is 2 (allowed: a whole number from 0 to 1)"},
      {bar(one_spring,
           R"(, "surface": {"position_m": [[0, 0, 0]], "facets": [], "first": [0, 2], "nodes": [0], "weights": [1]})"),
       "/surface/first/1: is 2"}};
  for (const auto& [text, expected] : cases)
    EXPECT_NE(message_of(text).find(expected), std::string::npos) << message_of(text);
  std::string no_cells = bar(one_spring);
  no_cells.replace(no_cells.find("\"springs\": {}"), 13, R"("volume_correction": {"kappa_Pa": 1, "form": "paper"})");
  EXPECT_NE(message_of(no_cells).find("/laws/volume_correction: has no cells to act on"), std::string::npos);
}

/// Twice the same cell would be twice as stiff, whatever the order of its corners.
TEST(SpringsFile, WhatIsNamedTwiceIsRefused) {
  SpringsFile file = file_of("hybmss");
  file.model = build_model(test::model("hybmss"), block_mesh({1, 1, 1}, {2, 2, 2}), material);
  file.surface = {};
  file.model.network.cells.corners.push_back(file.model.network.cells.corners[3]);
  EXPECT_NE(
      message_of(springs_as_json(file)).find("/cells/nodes: cells 3 and 8 connect the same nodes (allowed: one cell "),
      std::string::npos)
      << message_of(springs_as_json(file));
  SpringsFile planar = file_of("kirkwood");
  auto& triangles = planar.model.network.triangles;
  triangles.push_back({triangles[1][1], triangles[1][2], triangles[1][0]});
  EXPECT_NE(message_of(springs_as_json(planar)).find("/triangles: triangles 1 and "), std::string::npos)
      << message_of(springs_as_json(planar));
}

TEST(SpringsFile, DamagedIsReadOrRefused) {
  const char* all = std::getenv("SPRINGPROOF_DAMAGES");
  const int damages = all ? std::atoi(all) : 5000;
  SpringsFile file = file_of("hybmss_bt");
  file.model = build_model(test::model("hybmss_bt"), block_mesh({1, 1, 1}, {1, 1, 1}), material);
  file.surface = {};
  const std::string whole = springs_as_json(file);
  std::mt19937 generator(5);
  int read = 0;
  for (int d = 0; d < damages; ++d) {
    std::string text = whole;
    for (unsigned n = generator() % 3; n < 3; ++n) {
      const std::size_t at = generator() % text.size();
      switch (generator() % 4) {
        case 0:
          text[at] = static_cast<char>(generator());
          break;
        case 1:
          text[at] = "0123456789-.eE[]{},:\"nt"[generator() % 22];
          break;
        case 2:
          text.erase(at, 1 + generator() % 30);
          break;
        default:
          text.insert(at, text.substr(generator() % text.size(), generator() % 40));
      }
    }
    read += message_of(text) == "accepted";  // anything but an InputError ends the test
  }
  EXPECT_LT(read, damages / 2);
}

TEST(SpringsFile, HasAlignedArraysOfNumPy) {
  const std::string array = npy({"x", {2, 3}, std::vector<double>{1, 2, 3, 4, 5, 6}});
  EXPECT_EQ(array.substr(1, 5), "NUMPY");
  EXPECT_EQ((array.size() - 6 * sizeof(double)) % 64, 0u);
  EXPECT_NE(array.find("'shape': (2, 3)"), std::string::npos);
  EXPECT_NE(npy({"x", {4}, std::vector<std::int32_t>(4)}).find("'descr': '<i4', 'fortran_order': False, 'shape': (4,)"),
            std::string::npos);
}

/// As a model of a mesh: displacements at the mesh's nodes, in whatever order the file has them.
TEST(SpringsFile, IsEmbeddedAtTheNodesOfTheMesh) {
  const Mesh mesh = block_mesh({2, 1, 1}, {4, 2, 2});
  SpringsFile file = file_of("hybmss");
  file.model = build_model(test::model("hybmss"), mesh, material);
  const int last = file.model.network.nodes() - 1;
  Network& network = file.model.network;
  network.X = network.X.colwise().reverse().eval();
  network.volume.reverseInPlace();
  for (Spring& s : network.springs) s = {last - s.i, last - s.j, s.stiffness, s.rest_length};
  for (Hexahedron& cell : network.cells.corners)
    for (int& n : cell) n = last - n;
  file.surface = {};
  ModelParameters p;
  p.springs = std::make_shared<SpringsFile>(parse_springs(springs_as_json(file), "own.json"));
  const EmbeddedModel built = build_embedded(p, mesh, material);
  EXPECT_EQ(built.embedding.weights.nonZeros(), mesh.nodes.rows());
  EXPECT_LT((built.embedding.weights * built.model.network.X - mesh.nodes).norm(), 1e-12);
  EXPECT_EQ(built.embedding.held.at("x_min").size(), 9u);
  for (const int n : built.embedding.held.at("x_min")) EXPECT_EQ(built.model.network.X(n, 0), 0);
  EXPECT_THROW(build_embedded(p, block_mesh({20, 10, 10}, {4, 2, 2}), material), InputError);
  EXPECT_THROW(build_embedded(p, mesh, {1e4, 0.3, 1100}), InputError);
}

}  // namespace
}  // namespace springproof::springs_file_test
