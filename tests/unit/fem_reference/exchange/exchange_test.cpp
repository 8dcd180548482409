// What a request holds arrives as it was sent.
#include "fem_reference/exchange/exchange.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <tuple>

#include "problem/system/json.h"

namespace springproof::exchange_test {
namespace {

nlohmann::json through_cbor(const nlohmann::json& json) {
  return nlohmann::json::from_cbor(nlohmann::json::to_cbor(json));
}

fem::Request sent(const fem::Request& request) { return fem::request_from_json(through_cbor(to_json(request))); }

/// One of each kind, each member with a value of its own.
std::vector<Load> every_load() {
  const Wrench wrench{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
  Eigen::Matrix3d gradient;
  gradient << 1, 2, 3, 4, 5, 6, 7, 8, 9;
  const KelvinSolution kelvin{{1, 0, 2}, {0.5, 0.25, 0.125}, {1e4, 0.3, 1000}};
  return {PrescribedDisplacement{"z_min", {0.1, {}, -0.0}},
          PrescribedAffine{"z_max", gradient, {1, 2, 3}},
          PrescribedRotation{"x_min", {1, 2, 3}, {0, 0.6, 0.8}, 0.1},
          PrescribedField{"x_max", "kelvin", kelvin},
          Traction{"y_min", {1, 2, 3}, wrench},
          Pressure{"y_max", 2.5, {}},
          PatchForce{"tip", {4, 5, 6}, wrench},
          Gravity{{0, 0, -9.81}, {}},
          PointForce{{1, 2, 3}, {4, 5, 6}},
          FieldBodyForce{"trigonometric"}};
}

TEST(FemRequest, EveryKindOfLoadArrives) {
  fem::Request request;
  request.loads = every_load();
  std::set<std::size_t> kinds;
  for (const Load& load : request.loads) kinds.insert(load.index());
  ASSERT_EQ(kinds.size(), std::variant_size_v<Load>);
  const fem::Request arrived = sent(request);
  ASSERT_EQ(arrived.loads.size(), request.loads.size());
  for (std::size_t i = 0; i < request.loads.size(); ++i) EXPECT_EQ(arrived.loads[i].index(), request.loads[i].index());
  EXPECT_EQ(to_json(arrived), to_json(request));

  const auto& held = std::get<PrescribedDisplacement>(arrived.loads[0]);
  EXPECT_EQ(held.on, "z_min");
  EXPECT_EQ(held.displacement[0], 0.1);
  EXPECT_FALSE(held.displacement[1]);
  EXPECT_TRUE(std::signbit(*held.displacement[2]));
  const auto& affine = std::get<PrescribedAffine>(arrived.loads[1]);
  EXPECT_EQ(affine.gradient(0, 2), 3);
  EXPECT_EQ(affine.gradient(2, 0), 7);
  EXPECT_EQ(std::get<PrescribedRotation>(arrived.loads[2]).angle, 0.1);
  EXPECT_EQ(std::get<PrescribedField>(arrived.loads[3]).kelvin->material.poisson_ratio, 0.3);
  EXPECT_EQ(std::get<Traction>(arrived.loads[4]).wrench->moment, Vec3(4, 5, 6));
  EXPECT_FALSE(std::get<Pressure>(arrived.loads[5]).wrench);
  EXPECT_EQ(std::get<PointForce>(arrived.loads[8]).force, Vec3(4, 5, 6));
}

TEST(FemRequest, TheRestArrives) {
  fem::Request request;
  request.name = "liver.toml";
  request.geo = "/a b/block.geo";
  request.size = {1, 2, 3};
  request.law = "hencky";
  request.material = {1e4, 0.499, 1060};
  request.grids = {{{4, 5, 6}, "p2", 1.5, 0, 2, 3}};
  request.points = NodalVectors::Random(4, 3);
  request.stress_points = NodalVectors::Random(2, 3);
  request.tolerance = 1e-11;
  request.meshes = {std::make_shared<Mesh>(block_mesh(Vec3(1, 1, 1), {1, 1, 1}))};
  request.cost = true;
  request.modes = 7;
  request.regions = {{"tumour", {2e4, 0.45, 1070}, {}}};
  request.motion = fem::MotionRequest{2, 0.5, {.pulse = 0.25}, true, {1, 2, 3}, {4, 5, 6}, 0.125, {{{0.25, 3}}}, true};
  const fem::Request arrived = sent(request);
  EXPECT_EQ(to_json(arrived), to_json(request));
  EXPECT_EQ(arrived.geo, request.geo);
  EXPECT_EQ(arrived.points, request.points);
  EXPECT_EQ(arrived.stress_points.rows(), 2);
  EXPECT_EQ(arrived.meshes[0]->nodes, request.meshes[0]->nodes);
  EXPECT_TRUE(arrived.cost);
  EXPECT_EQ(arrived.modes, 7);
  ASSERT_TRUE(arrived.motion);
  const auto& [duration, damping, course, released, velocity, spin, viscosity, relaxation, energy_momentum] =
      *arrived.motion;
  EXPECT_EQ(std::tuple(duration, damping, course.pulse, released, viscosity), std::tuple(2, 0.5, 0.25, true, 0.125));
  EXPECT_EQ(velocity, Vec3(1, 2, 3));
  EXPECT_EQ(spin, Vec3(4, 5, 6));
  EXPECT_TRUE(energy_momentum);
  ASSERT_EQ(relaxation.branches.size(), 1u);
  EXPECT_EQ(relaxation.branches[0].time, 3);
  ASSERT_EQ(arrived.regions.size(), 1u);
  EXPECT_EQ(arrived.regions[0].material.density, 1070);
}

TEST(FemRequest, NumbersThatMakeNoMatrixAreRefused) {
  EXPECT_THROW(nlohmann::json({1, 2}).get<Vec3>(), std::runtime_error);
  EXPECT_THROW(nlohmann::json({1, 2, 3, 4}).get<NodalVectors>(), std::runtime_error);
  EXPECT_EQ(nlohmann::json({1, 2, 3, 4, 5, 6}).get<NodalVectors>().rows(), 2);
}

TEST(FemRequest, ALoadOfNoKindIsRefused) {
  nlohmann::json broken = to_json(fem::Request{});
  broken["loads"] = nlohmann::json::array({nlohmann::json::array({10, nullptr})});
  EXPECT_THROW(fem::request_from_json(broken), std::exception);
}

}  // namespace
}  // namespace springproof::exchange_test
