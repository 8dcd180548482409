// Patches by rules: every discretisation has the rule's area and bears the rule's force.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "comparisons/reference/reference_grids.h"
#include "comparisons/reference/voxel_reference.h"
#include "comparisons/run/prepare.h"
#include "fem_reference/exchange/reference.h"
#include "meshes/patches/rule_region.h"
#include "msm/embedding/boundary.h"

namespace springproof::rule_patch_test {
namespace {

struct RuleCase {
  const char* name;
  const char* body;  ///< and size
  const char* rule;
  const char* load;
  double area;  ///< [m^2]; 0: of a curved body, that of the finest mesh
};
void PrintTo(const RuleCase& c, std::ostream* out) { *out << c.name; }

constexpr const char* cube = "geo = \"block.geo\"\nsize_m = [1, 1, 1]";
constexpr const char* ball = "geo = \"sphere.geo\"\nsize_m = [1, 1, 1]";
constexpr const char* rod = "geo = \"cylinder.geo\"\nsize_m = [1, 1, 1]";
constexpr const char* bracket = "geo = \"l_bracket.geo\"\nsize_m = [1, 0.5, 1]";

const RuleCase cases[] = {
    {"pressure_on_a_box", cube, "box_m = [[0.34, 0.34, 0.9], [0.66, 0.66, 1.1]]", "pressure_Pa = 1000", 0.32 * 0.32},
    {"traction_on_a_disc", cube, "near = { point_m = [0.5, 0.5, 1.2], radius_m = 0.15 }",
     "traction_Pa = [300, 0, 1000]", M_PI * 0.15 * 0.15},
    {"traction_beyond_a_plane", cube,
     "beyond = { point_m = [0.5, 0.63, 0.5], normal = [0, 1, 0] }\nfacing = { direction = [0, 0, 1], within_deg = 5 }",
     "traction_Pa = [300, 0, 1000]", 0.37},
    {"pressure_on_a_part_of_a_disc", cube,
     "near = { point_m = [0.5, 0.5, 1], radius_m = 0.2 }\nbox_m = [[0, 0.5, 0], [1, 1, 1]]", "pressure_Pa = 70",
     M_PI * 0.02},
    {"pressure_on_a_disc_of_a_rod", rod, "near = { point_m = [0.45, 0.5, 1], radius_m = 0.3 }", "pressure_Pa = 1000",
     M_PI * 0.09},
    {"traction_on_a_spot_of_a_bracket", bracket,
     "near = { point_m = [0.8, 0.25, 0.15], radius_m = 0.1 }\nfacing = { direction = [0, 0, 1], within_deg = 20 }",
     "traction_Pa = [0, 0, -900]", M_PI * 0.01},
    {"pressure_on_a_cap", ball, "beyond = { point_m = [0.5, 0.5, 0.8], normal = [0, 0, 1] }", "pressure_Pa = 1000", 0},
    {"traction_on_the_side_of_a_rod", rod, "near = { point_m = [1, 0.5, 0.5], radius_m = 0.25 }",
     "traction_Pa = [300, 0, 1000]", 0},
};

Experiment experiment_of(const RuleCase& c, double edge, const char* reference) {
  return parse_experiment(fmt::format(R"([body]
{}
voxels = 300
[[patch]]
name = "spot"
{}
[[patch]]
name = "foot"
beyond = {{ point_m = [0.5, 0.5, {}], normal = [0, 0, -1] }}
[material]
youngs_modulus_Pa = 1e6
poisson_ratio = 0.3
[[load]]
on = "foot"
displacement_m = [0, 0, 0]
[[load]]
on = "spot"
{}
[compare]
models = ["hybmss"]
elements = ["q1", "p1"]
[reference]
edge_m = {}
{}
)",
                                      c.body, c.rule, c.body == bracket ? 0.1 : 0.23, c.load, edge, reference),
                          "rule.toml");
}

/// What the rule names of a mesh's own facets.
double area_of(const PatchRule& rule, const Mesh& mesh) {
  double sum = 0;
  for (const FacetPart& p : parts_of(rule, mesh)) sum += p.area.norm();
  return sum;
}

class RulePatches : public testing::TestWithParam<RuleCase> {};

TEST_P(RulePatches, HaveTheRulesAreaAndForceOnEveryDiscretisation) {
  const RuleCase& c = GetParam();
  const PreparedCase prepared = prepare(experiment_of(c, 0.12, ""));
  const double area = c.area > 0 ? c.area : area_of(prepared.experiment.patches[0], *prepared.body.tetrahedra.back());
  const Load& load = prepared.loads[1];
  Vec3 force = wrench_of(load)->value().force;
  if (const auto* t = std::get_if<Traction>(&load)) {
    EXPECT_LE((force - area * t->traction).norm(), 1e-6 * force.norm());
  } else if (c.area > 0) {
    EXPECT_NEAR(force.norm(), area * std::get<Pressure>(load).pressure, 1e-6 * force.norm());
  }
  std::vector<std::shared_ptr<const Mesh>> all = prepared.body.tetrahedra;
  for (const Lattice& lattice : prepared.lattices)
    if (lattice.tetrahedra) all.push_back(lattice.tetrahedra);
  ASSERT_EQ(all.size(), 4u);
  for (const auto& mesh : all) {
    const double own = nodal_areas(*mesh, patch(*mesh, "spot")).sum();
    if (c.area > 0) {
      EXPECT_NEAR(own, area, 1e-6 * area);
    }
    EXPECT_NEAR(own, area_of(prepared.experiment.patches[0], *mesh), 1e-4 * area);
  }
  all.push_back(prepared.lattices[0].mesh);
  for (const auto& mesh : all) {
    const Vec3 borne = transfer({load}, *mesh, 1000, Kinematics::linear).external.colwise().sum().transpose();
    EXPECT_LE((borne - force).norm(), 1e-10 * force.norm());
  }
}

TEST_P(RulePatches, HoldTheRulesAreaOnEveryMesh) {
  const PreparedCase prepared = prepare(experiment_of(GetParam(), 0.15, ""));
  const auto held = [&](const Mesh& m) { return nodal_areas(m, patch(m, "foot")).sum(); };
  for (const auto& mesh : prepared.body.tetrahedra) {
    if (GetParam().body == cube) {
      EXPECT_NEAR(held(*mesh), 1 + 4 * 0.23, 1e-9);
    }
    EXPECT_NEAR(held(*mesh), area_of(prepared.experiment.patches[1], *mesh), 1e-9);
  }
}

INSTANTIATE_TEST_SUITE_P(Cases, RulePatches, testing::ValuesIn(cases),
                         [](const auto& i) { return std::string(i.param.name); });

TEST(RulePatchesOnCurvedBodies, SpreadOfTheAreaIsPartOfTheUncertainty) {
  const PreparedCase cap = prepare(experiment_of(cases[6], 0.12, "")), box = prepare(experiment_of(cases[0], 0.12, ""));
  const auto area = [&](int i) {
    return nodal_areas(*cap.body.tetrahedra[i], patch(*cap.body.tetrahedra[i], "spot")).sum();
  };
  EXPECT_NEAR(cap.body.load_spread, std::abs(area(1) / area(2) - 1), 1e-12);
  EXPECT_GT(cap.body.load_spread, 1e-5);
  const auto says = [](const PreparedCase& c) {
    return std::any_of(c.body.notes.begin(), c.body.notes.end(), [](const std::string& n) {
      return n.find("% in the area of patch 'spot'") != std::string::npos;
    });
  };
  EXPECT_TRUE(says(cap));
  EXPECT_EQ(box.body.load_spread, 0);
  EXPECT_FALSE(says(box));
  ReferenceField field{
      NodalVectors::Constant(2, 3, 2), 0.01, Eigen::Vector2d(0.1, 0.2), {}, "", Sequence::converging, {}};
  widen(0.25, field);
  EXPECT_NEAR(field.uncertainty, 0.26, 1e-15);
  EXPECT_NEAR(field.nodal_uncertainty[1], 0.2 + 0.25 * std::sqrt(12), 1e-15);
}

/// The area of a rod's ends differs from mesh to mesh, by the facets of its rim; where they are held it changes
/// nothing.
TEST(RulePatchesOnCurvedBodies, TheAreaOfAHeldPatchIsNoUncertainty) {
  const auto rod_with = [](const char* load) {
    return prepare(parse_experiment(fmt::format(R"([body]
{}
voxels = 300
[[patch]]
name = "low"
facing = {{ direction = [0, 0, -1], within_deg = 5 }}
[[patch]]
name = "high"
facing = {{ direction = [0, 0, 1], within_deg = 5 }}
[material]
youngs_modulus_Pa = 1e6
poisson_ratio = 0.3
[[load]]
on = "low"
displacement_m = [0, 0, 0]
[[load]]
on = "high"
{}
[compare]
models = ["hybmss"]
[reference]
edge_m = 0.12
)",
                                                rod, load),
                                    "rod.toml"));
  };
  const PreparedCase twisted = rod_with("rotation_deg = 1\naxis = [0, 0, 1]\nabout_m = [0.5, 0.5, 1]");
  EXPECT_EQ(twisted.body.load_spread, 0);
  const PreparedCase pulled = rod_with("traction_Pa = [0, 0, 1000]");
  const auto area = [&](int i) {
    return nodal_areas(*pulled.body.tetrahedra[i], patch(*pulled.body.tetrahedra[i], "high")).sum();
  };
  EXPECT_NEAR(pulled.body.load_spread, std::abs(area(1) / area(2) - 1), 1e-12) << "of the two finest meshes";
  EXPECT_GT(pulled.body.load_spread, 1e-4);
}

/// Love (1929): how much less a half-space sinks at r than in the middle of a disc of radius a that is pressed, over
/// 4 (1 - nu^2) p a/(pi E).  In a body it is the same but for the cube of the disc's radius over the body's size.
double less_sunk_at(double r, double a) {
  const double k = std::min(r, a) / std::max(r, a);
  const double there =
      r <= a ? std::comp_ellint_2(k) : r / a * (std::comp_ellint_2(k) - (1 - k * k) * std::comp_ellint_1(k));
  return M_PI / 2 - there;
}

TEST(RulePatchesOfTheReference, AProbeAtTheRimOfASmallDiscIsAsCertainAsItSays) {
  if (!fem::available()) GTEST_SKIP() << "no springproof-fem";
  const double p = 1e4, E = 1e6, nu = 0.3, a = 0.05;
  const PreparedCase prepared = prepare(parse_experiment(R"([body]
geo = "block.geo"
size_m = [1, 1, 1]
voxels = 300
[[patch]]
name = "disc"
near = { point_m = [0.5, 0.5, 1], radius_m = 0.05 }
[material]
youngs_modulus_Pa = 1e6
poisson_ratio = 0.3
[[load]]
on = "z_min"
displacement_m = [0, 0, 0]
[[load]]
on = "disc"
pressure_Pa = 1e4
[[probe]]
name = "centre"
at_m = [0.5, 0.5, 1]
[[probe]]
name = "rim"
at_m = [0.55, 0.5, 1]
[[probe]]
name = "askew"
at_m = [0.53, 0.54, 1]
[[probe]]
name = "beyond"
at_m = [0.575, 0.5, 1]
[compare]
models = []
measures = ["probe"]
[reference]
elements = ["p2"]
edge_m = 0.14
)",
                                                         "disc.toml"));
  const ReferenceGrids grids = solve_body_grids(prepared, prepared.experiment.materials[0]);
  ASSERT_EQ(grids.failure, "");
  const auto limits = limits_of(prepared, grids.elements[0]);
  const auto probe = [&](const std::string& name) { return limits.at("displacement." + name + ".z"); };
  for (const auto& [name, r] : {std::pair("rim", 0.05), std::pair("askew", 0.05), std::pair("beyond", 0.075)}) {
    const double exact = 4 * (1 - nu * nu) * p * a / (M_PI * E) * less_sunk_at(r, a);
    EXPECT_NEAR(probe(name).value - probe("centre").value, exact, probe(name).uncertainty + probe("centre").uncertainty)
        << name << ": " << probe(name).note;
    EXPECT_FALSE(probe(name).observed_order) << name << ": " << probe(name).note;
  }
}

TEST(RulePatchReactions, AreTheRulesForceInLinearAndQuadraticElementsAndOnCubes) {
  if (!fem::available()) GTEST_SKIP() << "no springproof-fem";
  for (const RuleCase& c : {cases[0], cases[4]}) {
    const PreparedCase prepared = prepare(experiment_of(c, 0.2, "elements = [\"p2\", \"p1\"]"));
    const ReferenceGrids grids = solve_body_grids(prepared, prepared.experiment.materials[0]);
    ASSERT_EQ(grids.failure, "");
    const Vec3 force = wrench_of(prepared.loads[1])->value().force;
    std::vector<fem::Solution> solutions = grids.peers[0];
    for (const ElementGrids& e : grids.elements) solutions.insert(solutions.end(), e.grids.begin(), e.grids.end());
    EXPECT_EQ(solutions.size(), 8u);
    for (const fem::Solution& s : solutions) {
      ASSERT_TRUE(s.ok) << s.message;
      EXPECT_LE((s.reactions[0].force + force).norm(), 1e-6 * force.norm()) << c.name << " " << s.grid.element;
    }
  }
}

}  // namespace
}  // namespace springproof::rule_patch_test
