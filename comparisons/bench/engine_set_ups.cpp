// THE table of engines and of their set-ups.
#include "comparisons/bench/engine_adapter.h"

namespace springproof::bench {
namespace {

using Steps = std::vector<EngineSetUp::Step>;

// The first of each is the one that the tables of statics show.
const Steps mujoco_steps = {{1.0 / 60, 1, "discrete"}, {1.0 / 240, 1, "discrete"}, {1.0 / 1000, 1, "Euler"}};
const Steps bullet_steps = {{1.0 / 60, 1, "implicit"}, {1.0 / 240, 1, "implicit"}, {1.0 / 1000, 1, "implicit"}};
const Steps bullet_linear_steps = {
    {1.0 / 60, 1, "implicit"}, {1.0 / 240, 1, "implicit"}, {1.0 / 1000, 1, "implicit"}, {1.0 / 1000, 1, "explicit"}};
const Steps link_steps = {{1.0 / 60, 10, ""},         {1.0 / 60, 1, "", false},  {1.0 / 60, 100, "", false},
                          {1.0 / 240, 10, ""},        {1.0 / 240, 1, "", false}, {1.0 / 240, 100, "", false},
                          {1.0 / 1000, 10, "", false}};
const Steps jolt_steps = {{1.0 / 60, 0, ""},          {1.0 / 60, 1, "", false},  {1.0 / 60, 5, ""},
                          {1.0 / 60, 20, "", false},  {1.0 / 240, 1, "", false}, {1.0 / 240, 5, ""},
                          {1.0 / 1000, 1, "", false}, {1.0 / 1000, 5, ""}};

}  // namespace

const std::vector<EngineSetUp>& engine_set_ups() {
  using File = EngineSetUp::File;
  // clang-format off
  static const std::vector<EngineSetUp> all = {
      // name                                    adapter    set_up                 file              any nu  masses  forces
      {"MuJoCo, our export (5 tetrahedra)",      "mujoco",  "export",              File::mjcf,       true,   false,  true,  mujoco_steps},
      {"MuJoCo, full (6 tetrahedra)",            "mujoco",  "full",                File::tetrahedra, true,   true,   true,  mujoco_steps},
      {"MuJoCo, trilinear",                      "mujoco",  "trilinear",           File::tetrahedra, true,   true,   true,  mujoco_steps},
      {"MuJoCo, quadratic, cells twice as long", "mujoco",  "quadratic",           File::tetrahedra, true,   true,   true,  mujoco_steps},
      {"Bullet, linear elasticity",              "bullet",  "linear",              File::tetrahedra, true,   false,  true,  bullet_linear_steps},
      {"Bullet, neo-Hooke as entered",           "bullet",  "neo_hooke",           File::tetrahedra, true,   false,  true,  bullet_steps},
      {"Bullet, neo-Hooke converted",            "bullet",  "neo_hooke_converted", File::tetrahedra, true,   false,  true,  bullet_steps},
      {"Bullet, links, kLST 1",                  "bullet",  "links",               File::edges,      false,  false,  false, link_steps},
      {"Jolt, our export (msm_18)",              "jolt",    "edges",               File::edges,      false,  false,  false, jolt_steps},
  };
  // clang-format on
  return all;
}

}  // namespace springproof::bench
