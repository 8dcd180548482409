// What is advised of given predictions.
#include "comparisons/advise/advice.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace springproof::advice_test {
namespace {

/// Blocks of n^3 cells; errors of hybmss_avg fall as 0.1 / n, those of hybmss are 0.001 at n = 4 and 0.08 elsewhere,
/// quadratic elements' are 0.01 / n^2.
Forecast forecast() {
  Forecast f;
  f.geometry = "a cube";
  f.basis = "a test";
  f.load = "bending";
  f.material = {1e4, 0.3, 1000};
  f.models = {"hybmss", "hybmss_avg"};
  for (const int n : {1, 2, 4, 8, 16}) f.resolutions.push_back({std::pow(n, 3), double(n), 1.0 / n});
  f.predict = [](const std::string& model, const Resolution& r) -> std::optional<Prediction> {
    if (model == "hybmss") return Prediction{r.across == 4 ? 0.001 : 0.08, 1.2, false};
    return Prediction{0.1 / r.across, 1.2, false};
  };
  f.predict_element = [](const std::string& element, const Resolution& r) -> std::optional<Prediction> {
    if (element != "fem_q2") return {};
    return Prediction{0.01 / (r.across * r.across), 1.2, false};
  };
  return f;
}

std::string words_of(const Advice& a) {
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
  EXPECT_TRUE(a.choices[0].accurate && a.choices[0].affordable);
  EXPECT_GT(*a.choices[0].ms_per_step, 0);
  EXPECT_GT(a.choices[0].safe_step, 0);
  EXPECT_FALSE(a.choices[1].accurate);  // hybmss is right at four cells only, by coincidence
  EXPECT_NE(words_of(a).find("Take hybmss_avg with 4 cells across"), std::string::npos) << words_of(a);
  EXPECT_EQ(json_of(a)["models"][0]["cells_across"], 4);
}

TEST(Advice, APredictionWhoseRangeEndsFarAboveTheErrorIsUncertain) {
  Wish wish;
  wish.error = 0.03;
  EXPECT_NE(text_of(advise(forecast(), wish)).find("reaches it"), std::string::npos);
  Forecast wide = forecast();
  wide.predict = [](const std::string&, const Resolution& r) { return Prediction{0.1 / r.across, 20, false}; };
  wide.predict_element = [](const std::string&, const Resolution&) { return std::optional<Prediction>(); };
  const std::string text = text_of(advise(wide, wish));
  EXPECT_EQ(text.find("reaches it"), std::string::npos) << text;
  EXPECT_NE(text.find("uncertain"), std::string::npos) << text;
}

TEST(Advice, SaysWhenSpringsAreTheWrongTool) {
  Wish wish;
  wish.error = 1e-3;  // springs reach 0.006 on the finest lattice
  const Advice a = advise(forecast(), wish);
  EXPECT_FALSE(a.choices[0].accurate);
  EXPECT_NE(words_of(a).find("No mass-spring model reaches 0.1 %"), std::string::npos) << words_of(a);
  if (!a.elements.empty()) {  // springproof-fem is here
    EXPECT_EQ(a.elements[0].resolution.across, 4);
    EXPECT_NE(words_of(a).find("wrong tool"), std::string::npos) << words_of(a);
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
  EXPECT_FALSE(best.accurate && best.affordable);
  EXPECT_NE(words_of(tight).find("within the budget"), std::string::npos);
}

}  // namespace
}  // namespace springproof::advice_test
