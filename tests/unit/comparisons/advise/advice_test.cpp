// What is advised of given predictions.
#include "comparisons/advise/advice.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace springproof::advice_test {
namespace {

/// Cubes of n^3 cells; errors of hybmss_avg fall as 0.1 / n, those of hybmss are 0.001 at n = 4 and 0.08 elsewhere,
/// those of msm_18 are small by coincidence, those of quadratic elements 0.01 / n^2.
Forecast forecast(const std::vector<std::string>& models = {"hybmss", "hybmss_avg"}) {
  Forecast f;
  f.geometry = "a cube";
  f.basis = "a test";
  f.shares.bending = 1;
  f.material = {1e4, 0.3, 1000};
  f.materials = {f.material};
  f.models = models;
  for (const int n : {1, 2, 4, 8, 16}) f.resolutions.push_back({std::pow(n, 3), double(n), 1.0 / n});
  f.predict = [](const std::string& model, const Resolution& r) -> std::optional<Prediction> {
    if (model == "hybmss") return Prediction{r.across == 4 ? 0.001 : 0.08, 1.2, false};
    if (model == "msm_18") return Prediction{1e-5, 1.2, false};
    if (model == "fem_q2") return Prediction{0.01 / (r.across * r.across), 1.2, false};
    if (model == "fem_q1") return {};
    return Prediction{0.1 / r.across, 1.2, false};
  };
  return f;
}

std::string all_words(const Advice& a) {
  std::string all;
  for (const std::string& w : a.words) all += w + "\n";
  return all;
}

TEST(Advice, TakesTheCoarsestLatticeFromWhichOnAllAreAccurate) {
  Wish wish;
  wish.error = 0.03;
  const Advice a = advise(forecast(), wish);
  ASSERT_EQ(a.choices.size(), 2U);
  EXPECT_EQ(a.choices[0].model, "hybmss_avg");
  EXPECT_EQ(a.choices[0].resolution.across, 4);
  EXPECT_TRUE(a.choices[0].suits());
  EXPECT_GT(*a.choices[0].ms_per_step, 0);
  EXPECT_GT(a.choices[0].safe_step, 0);
  EXPECT_FALSE(a.choices[1].accurate);  // hybmss is right at four cells only, by coincidence
  EXPECT_EQ(a.choices[1].prediction.error, 0.08);
  EXPECT_NE(all_words(a).find("Take hybmss_avg with 4 cells across"), std::string::npos) << all_words(a);
  EXPECT_EQ(json_of(a)["models"][0]["cells_across"], 4);
}

TEST(Advice, APredictionWhoseRangeEndsFarAboveTheErrorIsUncertain) {
  Wish wish;
  wish.error = 0.03;
  EXPECT_NE(text_of(advise(forecast(), wish)).find("reaches it"), std::string::npos);
  Forecast wide = forecast();
  wide.predict = [](const std::string& model, const Resolution& r) -> std::optional<Prediction> {
    if (model.starts_with("fem_")) return {};
    return Prediction{0.1 / r.across, 20, false};
  };
  const std::string text = text_of(advise(wide, wish));
  EXPECT_EQ(text.find("reaches it"), std::string::npos) << text;
  EXPECT_NE(text.find("uncertain"), std::string::npos) << text;
}

TEST(Advice, SaysWhenSpringsAreTheWrongTool) {
  Wish wish;
  wish.error = 1e-3;  // springs reach 0.006 on the finest lattice
  const Advice a = advise(forecast(), wish);
  EXPECT_FALSE(a.choices[0].accurate);
  EXPECT_NE(all_words(a).find("No mass-spring model reaches 0.1 %"), std::string::npos) << all_words(a);
  if (!a.elements.empty()) {  // springproof-fem is here
    EXPECT_EQ(a.elements[0].resolution.across, 4);
    EXPECT_NE(all_words(a).find("wrong tool"), std::string::npos) << all_words(a);
  }
}

TEST(Advice, ABudgetLimitsTheLattice) {
  Wish wish;
  wish.error = 0.007;  // 16 cells across
  const Advice free = advise(forecast(), wish);
  EXPECT_EQ(free.choices[0].resolution.across, 16);
  EXPECT_TRUE(free.choices[0].accurate);
  wish.ms_per_step = *free.choices[0].ms_per_step / 8;  // four cells across take a 64th; the machine may be busy
  const Advice tight = advise(forecast(), wish);
  const Choice& best = tight.choices[0].model == "hybmss_avg" ? tight.choices[0] : tight.choices[1];
  EXPECT_LT(best.resolution.across, 16);
  EXPECT_FALSE(best.suits());
  EXPECT_NE(all_words(tight).find("within the budget"), std::string::npos);
}

TEST(Advice, ACostThatIsNotKnownIsNotOverTheBudget) {
  Forecast f = forecast({"hybmss_avg"});
  f.cut_steps["hybmss_avg"] = {0, 0, "it cannot move"};
  Wish wish;
  wish.ms_per_step = 1e-9;
  Advice a = advise(f, wish);
  ASSERT_EQ(a.choices.size(), 1U);
  EXPECT_EQ(a.choices[0].budget, Budget::unknown);
  EXPECT_EQ(text_of(a).find("over the budget"), std::string::npos) << text_of(a);
  EXPECT_NE(text_of(a).find("cost not known"), std::string::npos) << text_of(a);
  EXPECT_NE(all_words(a).find("hybmss_avg with 4 cells across (64 cells) reaches 3 %; whether within the budget (1e-09 "
                              "ms per step) is not known: it cannot move"),
            std::string::npos)
      << all_words(a);
  EXPECT_TRUE(json_of(a)["models"][0]["within_budget"].is_null());
  f.cut_steps["hybmss_avg"] = {1e-3, 1, ""};  // 64 ms
  a = advise(f, wish);
  EXPECT_EQ(a.choices[0].budget, Budget::over);
  wish.ms_per_step = 65;
  a = advise(f, wish);
  EXPECT_TRUE(a.choices[0].suits());
  EXPECT_NEAR(*a.choices[0].ms_per_step, 64, 1e-9);
  EXPECT_NEAR(a.choices[0].safe_step, 0.25, 1e-12);
}

TEST(Advice, AModelOfOnePoissonsRatioIsNamedAtThatRatioOnly) {
  const auto advice_at = [](double nu) {
    Forecast f = forecast({"msm_18"});
    f.material.poisson_ratio = nu;
    f.materials = {f.material};
    return advise(f, {});
  };
  const Advice elsewhere = advice_at(0.47);
  EXPECT_FALSE(elsewhere.choices[0].suits());
  EXPECT_EQ(all_words(elsewhere).find("msm_18"), std::string::npos) << all_words(elsewhere);
  EXPECT_NE(text_of(elsewhere).find("a solid of nu = 0.25 alone"), std::string::npos) << text_of(elsewhere);
  EXPECT_NE(all_words(advice_at(0.25)).find("Take msm_18 with 1 cell across (1 cell)"), std::string::npos);
}

TEST(Advice, TheRowThatTheWordsRecommendIsPrinted) {
  Wish wish;
  wish.error = 0.026;  // 4 cells: 0.025 times 1.2
  const Advice a = advise(forecast(), wish);
  ASSERT_TRUE(a.safer);
  EXPECT_EQ(a.safer->resolution.across, 8);
  EXPECT_NE(all_words(a).find("With 8 cells across (512 cells) it ends below."), std::string::npos) << all_words(a);
  const std::string text = text_of(a);
  for (const char* row : {"hybmss_avg                    64", "hybmss_avg                   512"})
    EXPECT_NE(text.find(row), std::string::npos) << row << "\n" << text;
  wish.error = 0.031;
  EXPECT_FALSE(advise(forecast(), wish).safer);
}

TEST(Advice, CellsAreWholeNumbers) {
  Forecast f = forecast({"hybmss_avg"});
  for (Resolution& r : f.resolutions) r = {1234567 * r.cells, 0, r.edge};
  f.predict = [](const std::string& model, const Resolution&) {
    return model == "hybmss_avg" ? std::optional<Prediction>({0.01, 1.2, false}) : std::nullopt;
  };
  const Advice a = advise(f, {});
  EXPECT_NE(all_words(a).find("Take hybmss_avg with 1234567 cells of"), std::string::npos) << all_words(a);
  EXPECT_NE(text_of(a).find("   1234567 "), std::string::npos) << text_of(a);
  EXPECT_EQ(json_of(a)["models"][0]["cells"].dump(), "1234567");
}

}  // namespace
}  // namespace springproof::advice_test
