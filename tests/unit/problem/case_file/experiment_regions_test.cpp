// [[region]]: what is read, what is refused.
#include <gtest/gtest.h>

#include <regex>

#include "problem/case_file/experiment.h"
#include "support/case_file.h"
#include "support/says.h"

namespace springproof::experiment_regions_test {
namespace {

using test::message_of;

const std::string body = R"([body]
geo = "hand.stl"
voxels = 1000

[material]
youngs_modulus_Pa = 1e4
poisson_ratio = [0.3, 0.45]
density_kg_m3 = 1100

[[load]]
on = "surface"
displacement_m = [0, 0, 0]

[reference]
elements = ["p2"]
)";
const std::string block = test::small_case;
const std::string alone = "[compare]\nmodels = []\n";
const std::string tumour =
    "[[region]]\nname = \"tumour\"\nvolume = \"t\"\nshear_modulus_Pa = 1e5\nbulk_modulus_Pa = 1e6\n";

TEST(CaseWithRegions, IsRead) {
  const Experiment e = parse_experiment(
      body + alone + tumour + "density_kg_m3 = 900\n[[region]]\nname = \"bone\"\nvolume = 3\n" +
          "youngs_modulus_Pa = 1e7\npoisson_ratio = 0.3\n[[region]]\nname = \"ball\"\nyoungs_modulus_Pa = 1\n"
          "poisson_ratio = 0\nnear = { point_m = [1, 2, 3], radius_m = 0.1 }\n",
      "case.toml");
  ASSERT_EQ(e.regions.size(), 3u);
  EXPECT_EQ(e.regions[0].name, "tumour");
  EXPECT_EQ(std::get<std::string>(e.regions[0].place), "t");
  EXPECT_NEAR(shear_modulus(e.regions[0].material), 1e5, 1e-9);
  EXPECT_EQ(e.regions[0].material.density, 900);
  EXPECT_EQ(std::get<std::string>(e.regions[1].place), "3");
  EXPECT_EQ(e.regions[1].material.density, 1100);  // of [material]
  EXPECT_EQ(std::get<PatchRule::Near>(e.regions[2].place).radius, 0.1);
}

TEST(CaseWithRegions, TakesASurfaceInTheLengthsOfTheBody) {
  const std::string moduli = "youngs_modulus_Pa = 1\npoisson_ratio = 0\n";
  const std::string stl = "[[region]]\nname = \"a\"\nstl = \"a.stl\"\n" + moduli;
  const auto place = [&](std::string text) {
    return std::get<EnclosedPlace>(parse_experiment(text, "folder/case.toml").regions.at(0).place);
  };
  const std::string scaled = std::regex_replace(body, std::regex("voxels"), "scale = 0.01\nvoxels");
  EXPECT_EQ(place(scaled + alone + stl).file, "folder/a.stl");
  EXPECT_EQ(place(scaled + alone + stl).scale, 0.01);
  EXPECT_EQ(place(scaled + alone + stl + "scale = 0.5\n").scale, 0.5);
  EXPECT_WORDS(message_of(body + alone + tumour + "scale = 2\n"), "region.scale: is of a file (allowed: beside stl)");
  EXPECT_WORDS(message_of(body + alone + tumour + "stl = \"a.stl\"\n"), "says twice where it lies");
}

TEST(CaseWithRegions, SaysOnceWhereEachLiesAndOfWhat) {
  const std::string nowhere = "[[region]]\nname = \"a\"\nyoungs_modulus_Pa = 1\npoisson_ratio = 0\n";
  EXPECT_WORDS(message_of(body + alone + nowhere),
               "does not say where it lies (allowed: one of volume, box_m, near, beyond");
  EXPECT_WORDS(message_of(body + alone + tumour + "box_m = [[0, 0, 0], [1, 1, 1]]\n"), "says twice where it lies");
  EXPECT_WORDS(message_of(body + alone + tumour + "poisson_ratio = 0.3\n"), "region: has 3 elastic moduli");
  EXPECT_WORDS(message_of(body + alone + tumour + tumour), "'tumour' is the name of another region");
}

const std::string one_nu = std::regex_replace(body, std::regex(R"(\[0.3, 0.45\])"), "0.3") + alone;

std::string region_of(const std::string& name, const std::string& moduli) {
  return "[[region]]\nname = \"" + name + "\"\nvolume = \"" + name + "\"\n" + moduli;
}

TEST(CaseWithRegions, ListsTheMaterialsOfOneOfThem) {
  const std::string soft = region_of("soft", "youngs_modulus_Pa = 10\npoisson_ratio = 0.4\n");
  const Experiment e = parse_experiment(
      one_nu + soft + region_of("core", "youngs_modulus_Pa = 5\npoisson_ratio = [0.2, 0.499]\n"), "case.toml");
  EXPECT_EQ(e.settings(), (std::vector<double>{0.2, 0.499}));
  EXPECT_EQ(e.listed_words(), "Poisson's ratio of core");
  EXPECT_EQ(e.at(1).regions[1].material.poisson_ratio, 0.499);
  EXPECT_EQ(e.at(1).setting_of(e.body_material(1)), 0.499);
  EXPECT_EQ(e.at(1).regions[0].material.poisson_ratio, 0.4);
  const Experiment contrast = parse_experiment(
      one_nu + region_of("core", "youngs_modulus_Pa = [1e2, 1e4, 1e6]\npoisson_ratio = 0.3\n"), "case.toml");
  EXPECT_EQ(contrast.settings(), (std::vector<double>{1e2, 1e4, 1e6}));
  EXPECT_EQ(contrast.listed_symbol(), "E of core");
  Experiment last = contrast;
  last.leave_out_settings([&](double E) { return E != contrast.settings().back(); });
  EXPECT_EQ(last.regions.front().material.youngs_modulus, contrast.settings().back());
  EXPECT_EQ(contrast.at(2).regions[0].material.youngs_modulus, 1e6);
  const Experiment one =
      parse_experiment(one_nu + region_of("core", "youngs_modulus_Pa = [1e2]\npoisson_ratio = 0.3\n"), "case.toml");
  EXPECT_EQ(one.settings(), (std::vector<double>{1e2}));
  EXPECT_EQ(one.listed_symbol(), "E of core");
  EXPECT_EQ(parse_experiment(one_nu + region_of("core", "youngs_modulus_Pa = 1\npoisson_ratio = [0.2]\n"), "case.toml")
                .listed_symbol(),
            "ν of core");
  EXPECT_EQ(contrast.materials_of_part(1).size(), 3u);
  EXPECT_EQ(contrast.materials_of_part(0).size(), 1u);
  const Experiment of_body = parse_experiment(body + alone + soft, "case.toml");
  EXPECT_EQ(of_body.materials_of_part(0).size(), 2u);
  EXPECT_EQ(of_body.materials_of_part(1).front().youngs_modulus, 10);
  EXPECT_EQ(of_body.settings(), (std::vector<double>{0.3, 0.45}));
  EXPECT_EQ(of_body.setting_of(of_body.body_material(1)), 0.45);
}

TEST(CaseWithRegions, ListsMaterialsInOnePlaceAlone) {
  const std::string list = region_of("core", "youngs_modulus_Pa = 5\npoisson_ratio = [0.2, 0.3]\n");
  EXPECT_WORDS(message_of(body + alone + list),
               "region.poisson_ratio: of 'core' is a list, and material.poisson_ratio in line 7 is one (allowed: a "
               "list in one place of the file)");
  EXPECT_WORDS(message_of(one_nu + list + region_of("shell", "youngs_modulus_Pa = [1, 2]\npoisson_ratio = 0\n")),
               "region.youngs_modulus_Pa: of 'shell' is a list, and region.poisson_ratio in line");
  EXPECT_WORDS(message_of(one_nu + region_of("core", "youngs_modulus_Pa = [1, 1]\npoisson_ratio = 0\n")),
               "region.youngs_modulus_Pa: gives the Young's modulus 1 twice (allowed: each once)");
  const Experiment e = parse_experiment(one_nu + list, "case.toml");
  try {
    require_one_listed(e);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_WORDS(error.what(),
                 "Poisson's ratio of core is a list (allowed here: one number, or --poisson-ratio with "
                 "one of 0.2, 0.3)");
  }
}

TEST(CaseWithRegions, IsRefusedWhereOneMaterialIsKnown) {
  EXPECT_WORDS(message_of(body + "[compare]\nmodels = [\"hybmss_avg\"]\nparts = true\n" + tumour),
               "the parts of errors");
  EXPECT_WORDS(message_of(body + "[compare]\nmodels = [\"hybmss_avg\"]\nmeasures = [\"promised_error\"]\n" + tumour),
               "which promised_error takes for an error");
  EXPECT_WORDS(message_of("kinematics = \"hencky\"\n" + body + alone + tumour +
                          "[material.relaxation]\nbranches = [{ share = 0.1, time_s = 1 }]\n"),
               "relaxation is of one material");
  const Experiment e = parse_experiment(body + alone + tumour, "case.toml");
  try {
    require_one_material(e, "advise");
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_WORDS(error.what(), "region: 'tumour': advise is for bodies of one material");
  }
}

TEST(CaseWithRegions, IsHintedAt) {
  EXPECT_WORDS(message_of(body + "[[regions]]\nname = \"a\"\n"),
               "; [[region]] is a part of the body of another material");
}

}  // namespace
}  // namespace springproof::experiment_regions_test
