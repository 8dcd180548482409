#include "comparisons/results/facts.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

namespace springproof::facts_test {
namespace {

const std::vector<FactGroup> groups = {{"a bar",
                                        {{"length", "m", {{"/bar/length_m", 0.25}}, "at rest"},
                                         {"error", "%", {{"/bar/errors/0", -0.0123}, {"/bar/errors/1", FactValue()}}},
                                         {"held", "", {{"/bar/held", true}}},
                                         {"", "Pa", {{"/bar/stress_Pa", 3.0}}}}},
                                       {"in JSON alone", {{"", "", {{"/axis", std::vector<double>{0, 0, 1}}}}}},
                                       {"warning: it may slip"}};

TEST(Facts, AreLinesOfText) {
  EXPECT_EQ(text_of(groups),
            "a bar\n"
            "  length         0.25 m   at rest\n"
            "  error         -1.23         none %\n"
            "  held            yes\n"
            "\n"
            "warning: it may slip\n");
}

TEST(Facts, AreAtTheirPlacesInJson) {
  EXPECT_EQ(json_of(groups), (nlohmann::json{{"bar",
                                              {{"length_m", 0.25},
                                               {"errors", nlohmann::json::array({-0.0123, nullptr})},
                                               {"held", true},
                                               {"stress_Pa", 3.0}}},
                                             {"axis", nlohmann::json::array({0.0, 0.0, 1.0})}}));
}

TEST(Facts, HaveNoInfiniteNumbers) {
  EXPECT_TRUE(std::holds_alternative<std::monostate>(if_finite(std::numeric_limits<double>::infinity())));
  EXPECT_EQ(std::get<double>(if_finite(2)), 2);
}

}  // namespace
}  // namespace springproof::facts_test
