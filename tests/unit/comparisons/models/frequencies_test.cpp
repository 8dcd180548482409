// Natural frequencies of modes that cross, and of a material that relaxes.
#include "comparisons/models/frequencies.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include "comparisons/run/prepare.h"
#include "fem_reference/exchange/reference.h"
#include "problem/processes/child.h"

namespace springproof::frequencies_test {
namespace {

PreparedCase relaxing_bar() {
  const std::string text = R"([body]
geo = "block.geo"
size_m = [0.4, 0.1, 0.1]
cells = [4, 1, 1]
[material]
youngs_modulus_Pa = 1e4
poisson_ratio = 0.3
density_kg_m3 = 1000
[material.relaxation]
branches = [{ share = 0.2, time_s = 0.5 }]
[[load]]
on = "x_min"
displacement_m = [0, 0, 0]
[compare]
models = ["hybmss_avg"]
[reference]
cells = [8, 4, 4]
)";
  return prepare_lattices(case_of_modes(parse_experiment(text, "bar.toml"), {.modes = 2}));
}

// Of a bar that is nearly square its model bends the other way first: one cell across is softer than three.
TEST(Frequencies, OfModesThatCrossArePairedByTheirShapes) {
  if (!fem::available()) GTEST_SKIP() << "no springproof-fem";
  const std::string text = R"([body]
geo = "block.geo"
size_m = [0.4, 0.1, 0.102]
cells = [4, 3, 1]
[material]
youngs_modulus_Pa = 1e4
poisson_ratio = 0.3
density_kg_m3 = 1000
[[load]]
on = "x_min"
displacement_m = [0, 0, 0]
[compare]
models = ["hybmss_avg"]
[reference]
cells = [16, 4, 4]
)";
  const PreparedCase prepared = prepare_lattices(case_of_modes(parse_experiment(text, "bar.toml"), {.modes = 2}));
  const FrequencyTable table =
      natural_frequencies(prepared, prepared.experiment.materials[0], {.modes = 2, .consistency = {0}}).front();
  ASSERT_EQ(table.failure, "");
  const ModelFrequencies& model = table.models.front();
  ASSERT_EQ(model.rows.size(), 2u);
  EXPECT_LT(table.reference[0].value, table.reference[1].value);
  EXPECT_GT(model.rows[0].frequency.value(), model.rows[1].frequency.value() * 1.01);
  for (const ModeRow& row : model.rows) EXPECT_GT(row.mac, 0.95);
}

/// The elements' program, which fails from its n-th call on.
class FailingProgram {
 public:
  explicit FailingProgram(int n) {
    std::ofstream(script_) << "#!/bin/sh\necho >>" << folder_.path.string() << "/calls\n[ $(wc -l <"
                           << folder_.path.string() << "/calls) -lt " << n << " ] || exit 1\nexec "
                           << SPRINGPROOF_BINARY_DIR << "/springproof-fem \"$@\"\n";
    std::filesystem::permissions(script_, std::filesystem::perms::owner_all);
    setenv("SPRINGPROOF_FEM_PROGRAM", script_.c_str(), 1);
  }
  ~FailingProgram() { unsetenv("SPRINGPROOF_FEM_PROGRAM"); }
  int calls() const {
    std::ifstream file(folder_.path / "calls");
    return static_cast<int>(std::count(std::istreambuf_iterator<char>(file), {}, '\n'));
  }

 private:
  TemporaryFolder folder_;
  std::filesystem::path script_ = folder_.path / "springproof-fem";
};

TEST(RelaxingFrequencies, AreThoseOfTheComplexModulus) {
  PreparedCase prepared = relaxing_bar();
  prepared.experiment.reference.elements.clear();
  const auto modes_of = [&](const Relaxation& relaxation, double modulus) {
    prepared.experiment.relaxation = relaxation;
    IsotropicMaterial material = prepared.experiment.materials[0];
    material.youngs_modulus *= modulus;
    material.poisson_ratio = 0;  // where all moduli of a bending mode are in proportion to G, but for the bulk modulus'
    return natural_frequencies(prepared, material, {.modes = 2, .consistency = {0}}).front().models.front().modes;
  };
  const Relaxation one{{{0.2, 0.5}}};
  const ModeSet relaxing = modes_of(one, 1), elastic = modes_of({}, 1);
  EXPECT_TRUE(elastic.damping.empty());
  ASSERT_GE(relaxing.damping.size(), 2u);
  const double f = relaxing.frequencies[0], w = 2 * 3.14159265358979 * f,
               stiffer = std::pow(f / elastic.frequencies[0], 2);
  // E' / E = 1 + c (storage - 1), E'' / E = c loss: the same c.
  const double c = (stiffer - 1) / (one.storage(w) - 1);
  EXPECT_GT(c, 0.6);
  EXPECT_LT(c, 1);
  EXPECT_NEAR(relaxing.damping[0], c * one.loss(w) / (2 * stiffer), 1e-9);
}

TEST(RelaxingFrequencies, WithoutTheModesOfASuddenStrainThereIsNoReference) {
  if (!fem::available()) GTEST_SKIP() << "no springproof-fem";
  const PreparedCase prepared = relaxing_bar();
  const auto table_by = [&](int failing_call, int& calls) {
    const FailingProgram program(failing_call);
    const FrequencyTable table = natural_frequencies(prepared, prepared.experiment.materials[0], {.modes = 2}).front();
    calls = program.calls();
    return table;
  };
  int calls = 0;
  EXPECT_EQ(table_by(100, calls).failure, "");
  ASSERT_GE(calls, 2);  // of long times, and sudden
  EXPECT_NE(table_by(calls, calls).failure, "");
}

}  // namespace
}  // namespace springproof::frequencies_test
