// Case files to test the reader with, and what "the same experiment" means.
#pragma once

#include <gtest/gtest.h>

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
most_unknowns = 1e6
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

inline void expect_same(const Load& a, const Load& b) {
  ASSERT_EQ(a.index(), b.index());
  if (const std::string* on = patch_of(a)) {
    EXPECT_EQ(*on, *patch_of(b));
  }
  if (const auto* p = std::get_if<PrescribedDisplacement>(&a)) {
    EXPECT_EQ(p->displacement, std::get<PrescribedDisplacement>(b).displacement);
  }
  if (const auto* p = std::get_if<PrescribedAffine>(&a)) {
    EXPECT_EQ(p->gradient, std::get<PrescribedAffine>(b).gradient);
    EXPECT_EQ(p->offset, std::get<PrescribedAffine>(b).offset);
  }
  if (const auto* p = std::get_if<PrescribedRotation>(&a)) {
    const auto& q = std::get<PrescribedRotation>(b);
    EXPECT_DOUBLE_EQ(p->angle, q.angle);  // written in degrees
    EXPECT_EQ(p->axis, q.axis);
    EXPECT_EQ(p->point, q.point);
  }
  if (const auto* p = std::get_if<Traction>(&a)) {
    EXPECT_EQ(p->traction, std::get<Traction>(b).traction);
  }
  if (const auto* p = std::get_if<PatchForce>(&a)) {
    EXPECT_EQ(p->force, std::get<PatchForce>(b).force);
  }
  if (const auto* p = std::get_if<PrescribedField>(&a)) {
    EXPECT_EQ(p->field, std::get<PrescribedField>(b).field);
  }
  if (const auto* p = std::get_if<FieldBodyForce>(&a)) {
    EXPECT_EQ(p->field, std::get<FieldBodyForce>(b).field);
  }
  if (const auto* p = std::get_if<Pressure>(&a)) {
    EXPECT_EQ(p->pressure, std::get<Pressure>(b).pressure);
  }
  if (const auto* p = std::get_if<Gravity>(&a)) {
    EXPECT_EQ(p->acceleration, std::get<Gravity>(b).acceleration);
  }
  if (const auto* p = std::get_if<PointForce>(&a)) {
    EXPECT_EQ(p->at, std::get<PointForce>(b).at);
    EXPECT_EQ(p->force, std::get<PointForce>(b).force);
  }
}

inline void expect_same(const PatchRule& a, const PatchRule& b) {
  EXPECT_EQ(a.name, b.name);
  ASSERT_EQ(a.box.has_value(), b.box.has_value());
  if (a.box) {
    EXPECT_EQ(a.box->low, b.box->low);
    EXPECT_EQ(a.box->high, b.box->high);
  }
  ASSERT_EQ(a.beyond.has_value(), b.beyond.has_value());
  if (a.beyond) {
    EXPECT_EQ(a.beyond->point, b.beyond->point);
    EXPECT_EQ(a.beyond->normal, b.beyond->normal);
  }
  ASSERT_EQ(a.facing.has_value(), b.facing.has_value());
  if (a.facing) {
    EXPECT_EQ(a.facing->direction, b.facing->direction);
    EXPECT_EQ(a.facing->within_deg, b.facing->within_deg);
  }
  ASSERT_EQ(a.near.has_value(), b.near.has_value());
  if (a.near) {
    EXPECT_EQ(a.near->point, b.near->point);
    EXPECT_EQ(a.near->radius, b.near->radius);
  }
}

/// Everything but places in the file.
inline void expect_same(const Experiment& a, const Experiment& b) {
  EXPECT_EQ(a.cite, b.cite);
  EXPECT_EQ(a.what, b.what);
  EXPECT_EQ(a.kinematics, b.kinematics);
  EXPECT_EQ(a.body.geo, b.body.geo);
  EXPECT_EQ(a.body.size, b.body.size);
  EXPECT_EQ(a.body.cells, b.body.cells);
  EXPECT_EQ(a.body.voxel_edges, b.body.voxel_edges);
  EXPECT_EQ(a.body.voxel_counts, b.body.voxel_counts);
  EXPECT_EQ(a.body.scale, b.body.scale);
  EXPECT_EQ(a.reference.edge, b.reference.edge);
  EXPECT_EQ(a.line.has_value(), b.line.has_value());
  ASSERT_EQ(a.patches.size(), b.patches.size());
  for (std::size_t i = 0; i < a.patches.size(); ++i) expect_same(a.patches[i], b.patches[i]);
  ASSERT_EQ(a.materials.size(), b.materials.size());
  for (std::size_t i = 0; i < a.materials.size(); ++i) {
    EXPECT_EQ(a.materials[i].youngs_modulus, b.materials[i].youngs_modulus);
    EXPECT_EQ(a.materials[i].poisson_ratio, b.materials[i].poisson_ratio);
    EXPECT_EQ(a.materials[i].density, b.materials[i].density);
  }
  ASSERT_EQ(a.loads.size(), b.loads.size());
  for (std::size_t i = 0; i < a.loads.size(); ++i) expect_same(a.loads[i], b.loads[i]);
  ASSERT_EQ(a.models.size(), b.models.size());
  for (std::size_t i = 0; i < a.models.size(); ++i) {
    EXPECT_EQ(a.models[i].name, b.models[i].name);
    EXPECT_EQ(a.models[i].options, b.models[i].options);
    EXPECT_EQ(a.models[i].label, b.models[i].label);
  }
  EXPECT_EQ(a.measures, b.measures);
  EXPECT_EQ(a.elements, b.elements);
  EXPECT_EQ(a.most_unknowns, b.most_unknowns);
  EXPECT_EQ(a.cost, b.cost);
  EXPECT_EQ(a.exact, b.exact);
  ASSERT_EQ(a.probes.size(), b.probes.size());
  for (std::size_t i = 0; i < a.probes.size(); ++i) {
    EXPECT_EQ(a.probes[i].name, b.probes[i].name);
    EXPECT_EQ(a.probes[i].at, b.probes[i].at);
  }
  ASSERT_EQ(a.section.has_value(), b.section.has_value());
  if (a.section) {
    EXPECT_EQ(a.section->point, b.section->point);
    EXPECT_EQ(a.section->normal, b.section->normal);
  }
  EXPECT_EQ(a.reference.cells, b.reference.cells);
  EXPECT_EQ(a.reference.elements, b.reference.elements);
  EXPECT_EQ(a.reference.grading, b.reference.grading);
  EXPECT_EQ(a.reference.smooth, b.reference.smooth);
  ASSERT_EQ(a.expectations.size(), b.expectations.size());
  for (std::size_t i = 0; i < a.expectations.size(); ++i) {
    const Expectation &p = a.expectations[i], &q = b.expectations[i];
    EXPECT_EQ(std::tie(p.model, p.poisson_ratio, p.cells, p.measure, p.source, p.value, p.within, p.relative,
                       p.at_least, p.where),
              std::tie(q.model, q.poisson_ratio, q.cells, q.measure, q.source, q.value, q.within, q.relative,
                       q.at_least, q.where));
  }
  ASSERT_EQ(a.published.size(), b.published.size());
  for (std::size_t i = 0; i < a.published.size(); ++i) {
    const PublishedValue &p = a.published[i], &q = b.published[i];
    EXPECT_EQ(std::tie(p.model, p.poisson_ratio, p.cells, p.measure, p.value, p.where, p.remark),
              std::tie(q.model, q.poisson_ratio, q.cells, q.measure, q.value, q.where, q.remark));
  }
}

}  // namespace springproof::test
