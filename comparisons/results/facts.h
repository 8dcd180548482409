// Facts that a command prints, as text or as JSON, each written once.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <variant>
#include <vector>

namespace springproof {

/// monostate: there is none, null in JSON.
using FactValue = std::variant<std::monostate, bool, double, std::string, std::vector<double>>;

struct Fact {
  std::string key;  ///< its place in the JSON, "/material/poisson_ratio"
  FactValue value;
};

/// Facts in one line.
struct FactRow {
  std::string label;  ///< "": in JSON alone
  std::string unit;   ///< "%": values are parts, printed in percent
  std::vector<Fact> facts;
  std::string note = {};  ///< behind the values, in text alone
};

/// Lines below a title.
struct FactGroup {
  std::string title;
  std::vector<FactRow> rows = {};
};

/// A number that is infinite where there is none.
FactValue if_finite(double x);

/// The rows with a label, each group below its title.
std::string text_of(const std::vector<FactGroup>& groups);

/// All facts, each at its place.
nlohmann::json json_of(const std::vector<FactGroup>& groups);

}  // namespace springproof
