// Case files to test the reader with.
#pragma once

#include "problem/case_file/experiment.h"

namespace springproof::test {

/// What the reader says against a case, or "accepted".
inline std::string message_of(const std::string& text) {
  try {
    parse_experiment(text, "case.toml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

/// Nothing but what is required.
inline constexpr const char* small_case = R"([body]
geo = "block.geo"
size_m = [1, 1.0, 2.5]
cells = [2, 2, 5]

[material]
youngs_modulus_Pa = 1e4
poisson_ratio = 0.3

[[load]]
on = "z_min"
displacement_m = [0, 0, 0]
)";

/// The beginning of a case of a bar that hangs from its end; it has no [compare].
inline constexpr const char* heavy_bar = R"(
[body]
geo = "block.geo"
size_m = [0.1, 0.03, 0.03]
cells = [10, 3, 3]

[material]
youngs_modulus_Pa = 2.5e5
poisson_ratio = 0.49
density_kg_m3 = 1070

[[load]]
on = "x_min"
displacement_m = [0, 0, 0]

[[load]]
gravity_m_s2 = [0, 0, -9.81]

)";

/// Every key of a body of hexahedra.
inline constexpr const char* full_case = R"(cite = "Golec et al. (2019), \"Table 3\""
what = "A beam with everything done to it."
kinematics = "hencky"

[body]
geo = "beam.geo"
size_m = [2.4, 0.4, 0.4]
cells = [[24, 4, 4], [48, 8, 8]]

[material]
shear_modulus_Pa = 4e3
poisson_ratio = [-0.5, 0.25, 0.499]
density_kg_m3 = 1060

[[load]]
on = ["x_min", "y_min"]
displacement_m = [0, "free", 0.5]

[[load]]
on = "z_min"
displacement_gradient = [[0.1, 0.2, 0.3], [0.4, 0.5, 0.6], [0.7, 0.8, 0.9]]

[[load]]
on = "z_max"
displacement_gradient = [[0, 0, 0], [0, 0, 0], [0, 0, 1e-3]]
displacement_m = [1, 2, 3]

[[load]]
on = "x_max"
rotation_deg = 45
axis = [0, 3, 4]
about_m = [1, 0.2, 0.2]

[[load]]
on = "y_max"
traction_Pa = [10, 0, -1e-3]

[[load]]
on = "y_max"
force_N = [0, 0, -5]

[[load]]
on = "y_max"
pressure_Pa = 2.5

[[load]]
gravity_m_s2 = [0, 0, -9.81]

[[load]]
force_N = [0, 1, 0]
at_m = [2.4, 0.2, 0.4]

[compare]
models = ["hybmss", { model = "hybmss", face_to_cube = 1.0, paper_e_form = true },
          { model = "emsm", weights = "share", label = "share" }, { model = "emsm", q = 0.25, damped = false }]
measures = ["displacement_error", "displacement_error_max", "section_distance", "volume_change",
            "volume_change_first_order", "reaction", "probe", "stress"]
elements = ["p1", "q1"]
max_unknowns = 1e6
cost = true

[section]
point_m = [1.2, 0, 0]
normal = [0, -2, 0]

[[probe]]
name = "tip"
at_m = [2.4, 0.2, 0.2]

[reference]
cells = [96, 16, 16]
elements = ["p2", "q1", "q2"]
grading = 1
smooth = true

[[expect]]
model = "hybmss A=1 paper_e_form"
poisson_ratio = 0.25
cells = [48, 8, 8]
measure = "force.x_max.magnitude"
source = "published"
value = 0.0254
within = 0.0005
where = "Table 3"

[[expect]]
model = "hybmss"
measure = "volume_change"
source = "extrapolated FEM"
within_relative = 0.02

[[expect]]
model = "fem"
measure = "displacement.tip.z"
source = "analytic"
value = -1.5
within = 1e-6

[[expect]]
model = "fem_p2"
measure = "stress.tip.xy"
source = "analytic"
value = 3.5
within_relative = 1e-2

[[published]]
model = "corotational FEM"
poisson_ratio = 0.499
cells = [10, 10, 10]
measure = "section_distance"
value = 0.1
where = "Fig. 4"
remark = "read from the figure"
)";

/// The reference alone, held against an exact field.
inline constexpr const char* verification_case = R"([body]
geo = "block.geo"
size_m = [1, 1, 1]
cells = [4, 4, 4]

[material]
youngs_modulus_Pa = 1e4
poisson_ratio = 0.3

[[load]]
on = ["x_min", "x_max", "y_min", "y_max", "z_min", "z_max"]
field = "trigonometric"

[[load]]
body_force_of = "trigonometric"

[compare]
models = []
measures = ["displacement_error", "displacement_error_order"]
exact = "trigonometric"

[reference]
cells = [16, 16, 16]
elements = ["q2", "p1"]

[[expect]]
model = "fem_p1"
measure = "displacement_error_order"
source = "analytic"
at_least = 1.9
)";

}  // namespace springproof::test
