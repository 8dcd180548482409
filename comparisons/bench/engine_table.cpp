#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "comparisons/bench/engines.h"

namespace springproof::bench {
namespace {

using Json = nlohmann::json;
using Results = std::vector<const EngineResult*>;
using Words = std::function<std::string(const EngineResult&)>;

Results select(const EngineFindings& e, const std::function<bool(const EngineResult&)>& wanted) {
  Results out;
  for (const EngineResult& r : e.results)
    if (wanted(r)) out.push_back(&r);
  std::stable_partition(out.begin(), out.end(), [](const EngineResult* r) { return !r->ours; });
  return out;
}

std::string percent(const EngineResult& r) {
  if (!r.why_not.empty()) return r.why_not == "burst" ? "burst" : "-";
  return fmt::format("{:+.1f}", 100 * r.error.value_or(0));
}

std::vector<std::string> distinct(const Results& results, const Words& words) {
  std::vector<std::string> out;
  for (const EngineResult* r : results)
    if (std::find(out.begin(), out.end(), words(*r)) == out.end()) out.push_back(words(*r));
  return out;
}

/// A table with a row per `row` and a column per `column`, both in the order of the results; nothing without results.
std::string pivot(const std::string& title, const Results& results, const Words& row, const Words& column,
                  const Words& cell) {
  if (results.empty()) return "";
  const std::vector<std::string> rows = distinct(results, row), columns = distinct(results, column);
  std::size_t width = 0;
  for (const std::string& name : rows) width = std::max(width, name.size());
  std::string out = fmt::format("\n{}\n{:{}}", title, "", width);
  std::vector<std::size_t> widths;
  for (const std::string& name : columns) {
    widths.push_back(std::max<std::size_t>(name.size(), 7));
    out += fmt::format("  {:>{}}", name, widths.back());
  }
  for (const std::string& name : rows) {
    out += fmt::format("\n{:{}}", name, width);
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const auto found = std::find_if(results.begin(), results.end(), [&](const EngineResult* r) {
        return row(*r) == name && column(*r) == columns[c];
      });
      out += fmt::format("  {:>{}}", found == results.end() ? "" : cell(**found), widths[c]);
    }
  }
  return out + "\n";
}

std::string engine_of(const EngineResult& r) { return r.engine; }
std::string after_comma(const std::string& quantity) {
  const auto at = quantity.find(", ");
  return at == std::string::npos ? quantity : quantity.substr(at + 2);
}

std::string references_text(const EngineFindings& e, const std::string& quantity) {
  std::string out;
  for (const auto& [key, value] : e.references)
    if (key.starts_with(quantity + ","))
      out += fmt::format("{}{}: {:.5g} +- {:.1g}", out.empty() ? "" : "; ", after_comma(key), value.value,
                         value.uncertainty);
  return out;
}

std::string step_of(const EngineResult& r) {
  return r.time_step == 0
             ? std::string("any")
             : fmt::format("1/{:.0f}{}{}", 1 / r.time_step, r.iterations > 1 ? fmt::format(" x {}", r.iterations) : "",
                           r.integrator.empty() ? "" : " " + r.integrator);
}

std::string statics_text(const EngineFindings& e, const std::string& quantity, const std::string& what) {
  const auto column = [](const EngineResult& r) { return fmt::format("{:g}: {}", r.poisson_ratio, r.cells); };
  Results results = select(e, [&](const EngineResult& r) { return r.quantity == quantity; });
  const auto by_column = [](const EngineResult* a, const EngineResult* b) {
    return std::pair(a->poisson_ratio, a->cells.size()) < std::pair(b->poisson_ratio, b->cells.size());
  };
  const auto rows = distinct(results, engine_of);
  std::stable_sort(results.begin(), results.end(), by_column);  // columns in order; rows as they come
  std::stable_sort(results.begin(), results.end(), [&](const EngineResult* a, const EngineResult* b) {
    return a->poisson_ratio == b->poisson_ratio && a->cells == b->cells &&
           std::find(rows.begin(), rows.end(), a->engine) < std::find(rows.begin(), rows.end(), b->engine);
  });
  return pivot(fmt::format("{}, error in %  (reference {})", what,
                           references_text(e, quantity.starts_with("tip") ? "tip" : quantity)),
               results, engine_of, column, percent);
}

std::string motion_text(const EngineFindings& e) {
  const auto starts = [](const char* with) {
    return [with](const EngineResult& r) { return r.quantity.starts_with(with); };
  };
  const auto row = [](const EngineResult& r) { return r.engine + "  " + (r.ours ? "safe step" : step_of(r)); };
  const auto cell = [](const EngineResult& r) {
    if (!r.why_not.empty()) return r.why_not == "no clean period" ? std::string("none") : percent(r);
    if (r.quantity.starts_with("frequency")) return percent(r);
    return r.quantity == "spin kept" ? fmt::format("{:.1f} %", 100 * r.value) : fmt::format("{:.4f}", r.value);
  };
  Results results = select(e, starts("frequency"));
  for (const char* more : {"damping", "spin kept"})
    for (const EngineResult* r : select(e, starts(more))) results.push_back(r);
  return pivot(
      fmt::format("Motion at nu = 0.25: first frequency in both bending planes, error in % (reference {} Hz); "
                  "damping, share of the critical; spin kept after four turns",
                  references_text(e, "frequency")),
      results, row, [](const EngineResult& r) { return r.quantity; }, cell);
}

std::string cost_text(const EngineFindings& e) {
  const Results results =
      select(e, [](const EngineResult& r) { return r.quantity == "cost" && r.poisson_ratio == 0.25; });
  const auto cell = [](const EngineResult& r) {
    return fmt::format("{:.3g} us, {:.0f}", r.value, 1e6 * r.time_step / r.value);
  };
  return pivot(
      "CPU time per node and step, and nodes in real time on one core; engines carry contact, switched off "
      "here, and WASM costs perhaps a factor of 2; never judged",
      results, [](const EngineResult& r) { return r.engine + "  " + step_of(r); },
      [](const EngineResult& r) { return r.cells; }, cell);
}

}  // namespace

std::string text_of(const EngineFindings& e) {
  const auto is = [](const char* quantity) {
    return [quantity](const EngineResult& r) { return r.quantity == quantity; };
  };
  std::string out;
  for (const auto& [adapter, version] : e.versions) out += fmt::format("{}\n", version);
  for (const std::string& line : e.not_measured) out += line + "\n";
  out += pivot(
      "Energy of prescribed fields over exact, 8x2x2, nu = 0.25",
      select(e, [](const EngineResult& r) { return r.quantity.starts_with("energy") && r.poisson_ratio == 0.25; }),
      engine_of, [](const EngineResult& r) { return after_comma(r.quantity); },
      [](const EngineResult& r) { return r.why_not.empty() ? fmt::format("{:.4f}", r.value) : "-"; });
  out += statics_text(e, "tip", "Tip of the cantilever under exact nodal loads");
  out += statics_text(e, "tip under its own gravity", "Tip under the engine's own gravity, where its masses differ");
  out += statics_text(e, "twist", "Twist under an end torque");
  out += statics_text(e, "volume change", "Change of volume under an end pressure");
  out += pivot("Tip at nu = 0.25, 8x2x2, by step and iterations, error in %", select(e, is("tip by step")), engine_of,
               step_of, percent);
  out += pivot(
      "Dependence of the tip on step and iterations: largest less smallest error, points", select(e, is("dependence")),
      engine_of, [](const EngineResult&) { return std::string("points"); },
      [](const EngineResult& r) { return fmt::format("{:.1f}", 100 * r.value); });
  out += motion_text(e) + cost_text(e);
  if (!out.empty())
    out +=
        "\nWith these versions and builds, as set up in comparisons/bench/engines/; what engines give up in accuracy "
        "buys robustness at any step,\nand contact.  Versions move; corrections are invited.\n";
  return out;
}

Json to_json(const EngineFindings& e) {
  Json results = Json::array(), references = Json::object();
  for (const EngineResult& r : e.results) {
    Json j = {{"engine", r.engine},
              {"quantity", r.quantity},
              {"cells", r.cells},
              {"poisson_ratio", r.poisson_ratio},
              {"ours", r.ours}};
    if (r.time_step > 0) j["time_step_s"] = r.time_step;
    if (r.iterations > 0) j["iterations"] = r.iterations;
    if (!r.integrator.empty()) j["integrator"] = r.integrator;
    if (r.why_not.empty())
      j["value"] = r.value;
    else
      j["why_not"] = r.why_not;
    if (r.error) j["error"] = *r.error;
    if (r.uncertainty) j["uncertainty"] = *r.uncertainty;
    results.push_back(j);
  }
  for (const auto& [key, value] : e.references)
    references[key] = {{"value", value.value}, {"uncertainty", value.uncertainty}};
  return {{"results", results},
          {"references", references},
          {"versions", e.versions},
          {"not_measured", e.not_measured},
          {"quick", e.quick}};
}

}  // namespace springproof::bench
