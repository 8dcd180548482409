// A ball held below and loaded in every way above, as a body of voxels.
#pragma once

#include <fmt/format.h>

#include "comparisons/run/case_run.h"
#include "comparisons/run/prepare.h"

namespace springproof::test {

/// Each kind of load that is no support, on the cap `high` or on the whole body.
inline constexpr const char* every_load = R"(
[[load]]
on = "high"
traction_Pa = [3, -2, 5]
[[load]]
on = "high"
pressure_Pa = 7
[[load]]
on = "high"
force_N = [0.01, 0.03, -0.02]
[[load]]
gravity_m_s2 = [1, -2, -9.81]
[[load]]
force_N = [0.02, -0.01, 0.04]
at_m = [0.06, 0.13, 0.11]
)";

inline std::string ball_case(int voxels, const std::string& loads, const std::string& models,
                             const std::string& reference) {
  return fmt::format(R"([body]
geo = "sphere.geo"
size_m = [0.2, 0.2, 0.2]
voxels = {}
[[patch]]
name = "low"
beyond = {{ point_m = [0.1, 0.1, 0.06], normal = [0.2, 0, -1] }}
[[patch]]
name = "high"
beyond = {{ point_m = [0.1, 0.1, 0.15], normal = [0.5, 0.3, 1] }}
[material]
youngs_modulus_Pa = 1e4
poisson_ratio = 0.3
density_kg_m3 = 1000
[[load]]
on = "low"
displacement_m = [0, 0, 0]
{}
[compare]
parts = true
models = [{}]
measures = ["displacement_error", "volume_change", "reaction", "probe"]
[[probe]]
name = "top"
at_m = [0.1, 0.1, 0.19]
[reference]
{}
)",
                     voxels, loads, models, reference);
}

inline PreparedCase prepared_ball(int voxels, const std::string& loads, const std::string& models,
                                  const std::string& reference) {
  return prepare(parse_experiment(ball_case(voxels, loads, models, reference), "ball.toml"));
}

}  // namespace springproof::test
