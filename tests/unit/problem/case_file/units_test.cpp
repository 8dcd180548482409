// A case in millimetres is the same case: read to the same body, loads and expectations in SI.
#include "problem/case_file/units.h"

#include <gtest/gtest.h>

#include "problem/case_file/experiment.h"
#include "support/case_file.h"

namespace springproof::units_test {
namespace {

// Numbers of the second one as they follow from mm, N, MPa and t.
constexpr const char* in_metres = R"(
[body]
geo = "block.geo"
size_m = [0.06, 0.01, 0.01]
cells = [12, 2, 2]
[[patch]]
name = "lower"
box_m = [[0, 0, 0], [0.06, 0.01, 0.005]]
[material]
youngs_modulus_Pa = 1e6
poisson_ratio = 0.3
density_kg_m3 = 1100
[[load]]
on = "x_min"
displacement_m = [0, "free", 0.002]
[[load]]
on = "x_max"
pressure_Pa = 2000
[[load]]
force_N = [0, 1, 0]
at_m = [0.06, 0.005, 0.01]
[[load]]
gravity_m_s2 = [0, 0, -9.81]
[compare]
models = ["hybmss"]
measures = ["displacement_error", "reaction", "probe"]
[[probe]]
name = "tip"
at_m = [0.06, 0.005, 0.005]
[[expect]]
model = "hybmss"
measure = "displacement.tip.z"
source = "analytic"
value = -0.002
within = 1e-6
[[expect]]
model = "hybmss"
measure = "torque.x_min.y"
source = "analytic"
value = 0.5
within_relative = 0.02
[[published]]
model = "FEM"
poisson_ratio = 0.3
measure = "force.x_min.z"
value = 3
where = "Fig. 1"
)";
constexpr const char* in_millimetres = R"(units = "mm"
[body]
geo = "block.geo"
size_mm = [60, 10, 10]
cells = [12, 2, 2]
[[patch]]
name = "lower"
box_mm = [[0, 0, 0], [60, 10, 5]]
[material]
youngs_modulus_MPa = 1
poisson_ratio = 0.3
density_t_mm3 = 1.1e-9
[[load]]
on = "x_min"
displacement_mm = [0, "free", 2]
[[load]]
on = "x_max"
pressure_MPa = 2e-3
[[load]]
force_N = [0, 1, 0]
at_mm = [60, 5, 10]
[[load]]
gravity_mm_s2 = [0, 0, -9810]
[compare]
models = ["hybmss"]
measures = ["displacement_error", "reaction", "probe"]
[[probe]]
name = "tip"
at_mm = [60, 5, 5]
[[expect]]
model = "hybmss"
measure = "displacement.tip.z"
source = "analytic"
value = -2
within = 1e-3
[[expect]]
model = "hybmss"
measure = "torque.x_min.y"
source = "analytic"
value = 500
within_relative = 0.02
[[published]]
model = "FEM"
poisson_ratio = 0.3
measure = "force.x_min.z"
value = 3
where = "Fig. 1"
)";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

TEST(Units, ACaseInMillimetresIsTheSameCase) {
  const Experiment m = parse_experiment(in_metres, "case.toml"), mm = parse_experiment(in_millimetres, "case.toml");
  EXPECT_EQ(m.units, Units::m);
  EXPECT_EQ(mm.units, Units::mm);
  EXPECT_TRUE(mm.body.size.isApprox(m.body.size, 1e-14));
  EXPECT_TRUE(mm.patches[0].box->high.isApprox(m.patches[0].box->high, 1e-14));
  EXPECT_DOUBLE_EQ(mm.materials[0].youngs_modulus, 1e6);
  EXPECT_DOUBLE_EQ(mm.materials[0].density, 1100);
  ASSERT_EQ(mm.loads.size(), m.loads.size());
  EXPECT_DOUBLE_EQ(*std::get<PrescribedDisplacement>(mm.loads[0]).displacement[2], 0.002);
  EXPECT_DOUBLE_EQ(std::get<Pressure>(mm.loads[1]).pressure, 2000);
  EXPECT_EQ(std::get<PointForce>(mm.loads[2]).force, Vec3(0, 1, 0));
  EXPECT_TRUE(std::get<PointForce>(mm.loads[2]).at.isApprox(Vec3(0.06, 0.005, 0.01), 1e-14));
  EXPECT_DOUBLE_EQ(std::get<Gravity>(mm.loads[3]).acceleration[2], -9.81);
  EXPECT_TRUE(mm.probes[0].at.isApprox(m.probes[0].at, 1e-14));
  EXPECT_DOUBLE_EQ(*mm.expectations[0].value, -0.002);
  EXPECT_DOUBLE_EQ(mm.expectations[0].within, 1e-6);
  EXPECT_DOUBLE_EQ(*mm.expectations[1].value, 0.5);
  EXPECT_EQ(mm.expectations[1].within, 0.02);
  EXPECT_EQ(mm.published[0].value, 3);
}

TEST(Units, FilesOfBodiesAreInThem) {
  const auto scale_of = [](const std::string& units, const std::string& file) {
    return parse_experiment(units + "[body]\ngeo = \"" + file + "\"\nvoxels = 100\n[material]\nyoungs_modulus_" +
                                (units.empty() ? "Pa" : "MPa") +
                                " = 1\npoisson_ratio = 0.3\n[[load]]\non = \"a\"\nforce_N = [1, 0, 0]\n",
                            "case.toml")
        .body.scale;
  };
  EXPECT_EQ(scale_of("", "a.stl"), 1);
  EXPECT_EQ(scale_of("units = \"mm\"\n", "a.stl"), 1e-3);
  EXPECT_EQ(scale_of("units = \"mm\"\n", "a.STEP"), 1);  // states its unit
}

TEST(Units, KeysOfTheOtherUnitsAreRefusedWithTheirPlace) {
  EXPECT_NE(test::message_of(replaced(in_millimetres, "size_mm", "size_m"))
                .find("case.toml:4:1: body.size_m: unknown key (allowed: geo, size_mm"),
            std::string::npos);
  EXPECT_NE(test::message_of(replaced(in_millimetres, "size_mm", "size_m")).find("under units = \"mm\" it is size_mm"),
            std::string::npos);
  const std::string said = test::message_of(replaced(in_metres, "youngs_modulus_Pa", "youngs_modulus_MPa"));
  EXPECT_NE(said.find("case.toml:10:1: material.youngs_modulus_MPa: unknown key"), std::string::npos) << said;
  EXPECT_NE(said.find("youngs_modulus_Pa, or units = \"mm\" at the top of the file"), std::string::npos) << said;
  const std::string none = test::message_of(replaced(in_millimetres, "youngs_modulus_MPa = 1\n", ""));
  EXPECT_NE(none.find("exactly two of youngs_modulus_MPa, poisson_ratio, shear_modulus_MPa"), std::string::npos)
      << none;
  EXPECT_NE(test::message_of(std::string("units = \"cm\"") + in_metres).find("case.toml:1:9: units: 'cm' is not known"),
            std::string::npos);
}

}  // namespace
}  // namespace springproof::units_test
