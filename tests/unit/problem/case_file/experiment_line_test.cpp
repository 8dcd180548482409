// [line], the field "kelvin" and bodies of voxels: what is read, what is refused.
#include <gtest/gtest.h>

#include "problem/case_file/experiment.h"
#include "problem/case_file/measures.h"
#include "support/case_file.h"

namespace springproof::experiment_line_test {
namespace {

using test::message_of;

const std::string line_case = R"([body]
geo = "sphere.geo"
size_m = [2, 2, 2]
voxel_edge_m = 0.25

[material]
youngs_modulus_Pa = 100
poisson_ratio = 0.25

[[load]]
on = "surface"
field = "kelvin"

[[load]]
force_N = [0, 10, 0]
at_m = [1, 1, 1]

[line]
from_m = [1, 1, 1]
to_m = [2, 1, 1]
points = 40
middle = [7, 30]

[compare]
models = ["msm_18"]
measures = ["line"]

[reference]
elements = []
)";

std::string edited(const std::string& old, const std::string& with) {
  std::string text = line_case;
  const std::size_t at = text.find(old);
  EXPECT_NE(at, std::string::npos) << old;
  return text.replace(at, old.size(), with);
}

TEST(LineCase, IsRead) {
  const Experiment e = parse_experiment(line_case, "case.toml");
  EXPECT_EQ(e.body.voxel_edges, std::vector<double>{0.25});
  ASSERT_TRUE(e.line);
  EXPECT_EQ(e.line->points, 40);
  EXPECT_EQ(e.line->middle, (std::array<int, 2>{7, 30}));
  EXPECT_EQ(point_of(*e.line, 10), Vec3(1.25, 1, 1));
  EXPECT_EQ(point_of(*e.line, 40), Vec3(2, 1, 1));
  const auto& load = std::get<PrescribedField>(e.loads[0]);
  ASSERT_TRUE(load.kelvin);
  EXPECT_EQ(load.kelvin->force, Vec3(0, 10, 0));
  EXPECT_EQ(load.kelvin->at, Vec3(1, 1, 1));
  const Vec3 X(2, 1.5, 1);
  const PrescribedValue u = prescribed_displacement(e.loads[0], X, Kinematics::linear, 0.5);
  for (int d = 0; d < 3; ++d) EXPECT_DOUBLE_EQ(*u[d], 0.5 * kelvin_displacement(*kelvin_of(e), X)[d]);
}

TEST(LineCase, RowsHaveOrdersWhereThereAreSeveralLattices) {
  const Experiment one = parse_experiment(line_case, "case.toml");
  const Experiment two = parse_experiment(edited("voxel_edge_m = 0.25", "cells = [[8, 8, 8], [4, 4, 4]]"), "case.toml");
  EXPECT_EQ(rows_of_measure("line", one).size(), 14u);
  EXPECT_EQ(rows_of_measure("line", two).size(), 16u);
}

struct Mistake {
  const char* old;
  const char* with;
  const char* says;
};

TEST(LineCase, MistakesAreExplained) {
  const Mistake mistakes[] = {
      {"points = 40", "points = 1", ":21:10: line.points: is 1 (allowed: an integer from 2 to 10000)"},
      {"points = 40", "points = 4.5", "line.points: is no integer"},
      {"middle = [7, 30]", "middle = [7, 41]", "line.middle: is 41 (allowed: an integer from 7 to 40)"},
      {"middle = [7, 30]", "middle = [0, 30]", "line.middle: is 0"},
      {"middle = [7, 30]", "middle = [7]", "line.middle"},
      {"middle", "midle", "did you mean 'middle'?"},
      {"to_m = [2, 1, 1]\n", "", "line.to_m"},
      {"to_m = [2, 1, 1]", "to_m = [1, 1, 1]", "line.to_m: is from_m"},
      {"from_m = [1, 1, 1]", "from_m = [0, 1, 1]", "has its point 20 where the point force acts"},
      {"[line]\nfrom_m = [1, 1, 1]\nto_m = [2, 1, 1]\npoints = 40\nmiddle = [7, 30]\n", "", "'line' needs one"},
      {"at_m = [1, 1, 1]", "at_m = [1, 1, 1]\n[[load]]\nforce_N = [0, 10, 0]\nat_m = [1, 1, 1]",
       "needed: exactly one point force"},
      {"poisson_ratio = 0.25", "poisson_ratio = [0.2, 0.25]", "needed: one material"},
      {"[body]", "kinematics = \"hencky\"\n[body]", "needed: kinematics = \"linear\""},
      {"field = \"kelvin\"", "field = \"kelvn\"", "did you mean 'kelvin'?"},
      {"field = \"kelvin\"", "displacement_m = [0, 0, 0]\n[[load]]\nforce_N = [0, 10, 0]\nat_m = [1, 1, 1]",
       "is held against Kelvin's solution"},
      {"elements = []", "elements = [\"q2\"]", "reference.elements: 'q2' is not known (allowed: p2, p1)"},
      {"voxel_edge_m = 0.25", "voxel_edge_m = 0", "body.voxel_edge_m"},
  };
  for (const Mistake& m : mistakes) {
    const std::string message = message_of(edited(m.old, m.with));
    EXPECT_NE(message.find(m.says), std::string::npos) << message << "\nlacks: " << m.says;
  }
}

TEST(LineCase, KelvinsFieldGoesWithFiniteElementsToo) {
  std::string text = edited("elements = []", "elements = [\"q2\"]");
  text.replace(text.find("voxel_edge_m = 0.25"), 19, "cells = [8, 8, 8]");
  const Experiment e = parse_experiment(text, "case.toml");
  EXPECT_TRUE(std::get<PrescribedField>(e.loads[0]).kelvin);
}

}  // namespace
}  // namespace springproof::experiment_line_test
