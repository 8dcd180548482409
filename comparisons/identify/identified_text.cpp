#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "comparisons/identify/identified.h"
#include "comparisons/results/records_json.h"

namespace springproof {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(IdentifiedParameter, name, of, start, lower, upper, logarithmic, held, value, u_data,
                                   u_inputs, u_numerical, u, from, to, inputs)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(IdentifiedValue, name, load_case, unit, fitted, measured, u_measured, simulated,
                                   residual, u_numerical, u_fit, u_fit_numerical, u_input, u_val, ratio)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(KnownDirection, along, u)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SyntheticSets, sets, inside)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Identified, case_name, name, model, cells, ok, message, iterations, parameters,
                                   correlation, directions, values, chi2, freedom, worst, synthetic, runs, kept,
                                   sentences)

namespace {

std::string number_or_none(const std::optional<double>& x, const char* form) {
  return x ? fmt::format(fmt::runtime(form), *x) : "–";
}

std::string parameters_text(const Identified& out) {
  constexpr const char* form = "{:<28} {:>11} {:>9} {:>23}  {:>9} {:>9} {:>9}\n";
  std::string text = fmt::format(form, "", "value", "u", "95 % limits", "by data", "by inputs", "by cells");
  for (const IdentifiedParameter& p : out.parameters)
    text += fmt::format(form, p.name, fmt::format("{:.5g}", p.value), p.held ? "held" : fmt::format("{:.2g}", p.u),
                        fmt::format("{:.4g} ... {:.4g}", p.from, p.to), fmt::format("{:.2g}", p.u_data),
                        number_or_none(p.u_inputs, "{:.2g}"), number_or_none(p.u_numerical, "{:.2g}"));
  for (std::size_t i = 0; i < out.parameters.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      text += fmt::format("correlation of {} and {}{}: {:.3f}\n", out.parameters[k].name, out.parameters[i].name,
                          out.parameters[i].held || out.parameters[k].held ? ", were none held" : "",
                          out.correlation[i][k]);
  return text;
}

std::string values_text(const Identified& out) {
  constexpr const char* form = "{:<28} {:>11} {:>11} {:<4} {:>8} {:>9} {:>8}\n";
  std::string text = fmt::format(form, "", "S", "D", "", "E/u_D", "u_val [%]", "|E|/u_val");
  for (const bool fitted : {true, false})
    for (const IdentifiedValue& v : out.values)
      if (v.fitted == fitted)
        text += fmt::format(
            form, v.name, number_or_none(v.simulated, "{:.5g}"),
            std::isfinite(v.measured) ? fmt::format("{:.5g}", v.measured) : "awaited", v.unit,
            number_or_none(v.residual, "{:+.2f}"),
            v.u_val && std::isfinite(v.measured) ? fmt::format("{:.1f}", 100 * *v.u_val / std::abs(v.measured)) : "",
            fitted ? "fitted" : number_or_none(v.ratio, "{:.1f}"));
  return text;
}

std::string synthetic_text(const Identified& out) {
  if (out.synthetic.sets == 0) return "";
  std::string text;
  std::size_t free = 0;
  for (const IdentifiedParameter& p : out.parameters)
    if (!p.held)
      text += fmt::format("Of {} synthetic sets {} have {} within their limits of 95 %.\n", out.synthetic.sets,
                          out.synthetic.inside[free++], p.name);
  return text;
}

}  // namespace

std::string json_text(const std::vector<Identified>& all) { return nlohmann::json(all).dump(2) + "\n"; }

std::string text_of(const Identified& out) {
  std::vector<std::string> cells;
  for (const Cells& c : out.cells) cells.push_back(cells_text(c));
  std::string text =
      fmt::format("\n{}, {}: by {} on {} cells\n", out.case_name, out.name, out.model, fmt::join(cells, ", "));
  if (!out.ok) return text + fmt::format("no result: {}\n", out.message);
  text += parameters_text(out) + "\n" + values_text(out);
  text += fmt::format("chi² {:.3g} of {}; {} steps; {} runs made, {} kept from before\n", out.chi2, out.freedom,
                      out.iterations, out.runs, out.kept);
  for (const std::string& sentence : out.sentences) text += sentence + "\n";
  return text + synthetic_text(out);
}

}  // namespace springproof
