#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "comparisons/identify/identified.h"
#include "comparisons/identify/least_squares.h"
#include "comparisons/judge/validation.h"
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

constexpr double most_correlation = 0.99;  // of which nothing is said

/// "youngs_modulus_Pa × 0.91", a step along a direction that stays within a tenth of each range.
std::string step_words(const Identified& out, const KnownDirection& direction) {
  double scale = direction.u;
  for (std::size_t p = 0; p < out.parameters.size(); ++p) {
    const IdentifiedParameter& parameter = out.parameters[p];
    const double range =
        parameter.logarithmic ? std::log(parameter.upper / parameter.lower) : parameter.upper - parameter.lower;
    if (direction.along[p] != 0) scale = std::min(scale, most_of_range * range / std::abs(direction.along[p]));
  }
  std::vector<std::string> words;
  for (std::size_t p = 0; p < out.parameters.size(); ++p) {
    const double step = scale * direction.along[p];
    if (std::abs(direction.along[p]) < 0.01) continue;
    words.push_back(out.parameters[p].logarithmic ? fmt::format("{} × {:.3g}", out.parameters[p].name, std::exp(step))
                                                  : fmt::format("{} {:+.3g}", out.parameters[p].name, step));
  }
  return fmt::format("{}", fmt::join(words, " with "));
}

bool disagree(const Identified& out) {
  return out.freedom > 0 && out.chi2 > out.freedom + 2 * std::sqrt(2.0 * out.freedom);
}

/// Of a parameter, over its range, as it is sought.
double share_of_range(const IdentifiedParameter& p) {
  return p.logarithmic ? p.u_data / p.value / std::log(p.upper / p.lower) : p.u_data / (p.upper - p.lower);
}

/// What the uncertainties leave out.
std::vector<std::string> lacks_of(const Identified& out) {
  std::vector<std::string> all;
  for (const IdentifiedParameter& p : out.parameters) {
    if (p.held) continue;
    std::vector<std::string> without;
    for (const InputShare& input : p.inputs)
      if (!input.change) without.push_back("'" + input.input + "'");
    if (!without.empty())
      all.push_back(fmt::format("The limits of {} are without the input {}: with it changed a fitted value is missing.",
                                p.name, fmt::join(without, ", ")));
    if (!p.u_numerical)
      all.push_back(
          fmt::format("The limits of {} are without the cells: there is no limit of several lattices.", p.name));
  }
  return all;
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

std::vector<std::string> sentences_of(const Identified& out) {
  std::vector<std::string> all;
  bool held = false;
  for (const IdentifiedParameter& p : out.parameters) {
    held = held || p.held;
    if (p.held)
      all.push_back(fmt::format(
          "The values do not tell {}: it is held at {:.6g}{}.", p.name, p.value,
          disagree(out) ? "" : fmt::format(", and anything from {:.3g} to {:.3g} would fit as well", p.from, p.to)));
    else if (share_of_range(p) > most_of_range)
      all.push_back(fmt::format("The values do not tell {}: anything from {:.3g} to {:.3g} would fit as well.", p.name,
                                p.from, p.to));
    else if (p.value <= p.lower || p.value >= p.upper)
      all.push_back(fmt::format("{} is at its bound, {:.6g}.", p.name, p.value));
  }
  if (held)
    all.push_back("Along " + step_words(out, out.directions.front()) + " no fitted value changes by more than its u.");
  for (std::size_t i = 0; i < out.parameters.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      if (!out.parameters[i].held && !out.parameters[k].held && std::abs(out.correlation[i][k]) > most_correlation)
        all.push_back(fmt::format("{} and {} are all but told together: their correlation is {:.3f}.",
                                  out.parameters[k].name, out.parameters[i].name, out.correlation[i][k]));
  for (std::string& lack : lacks_of(out)) all.push_back(std::move(lack));
  if (disagree(out))
    all.push_back(
        fmt::format("The fitted values do not agree with one another within their u: chi² = {:.3g} of {}; worst: {}.",
                    out.chi2, out.freedom, out.worst));
  int off = 0, predicted = 0;
  for (const IdentifiedValue& v : out.values) {
    if (!v.ratio) continue;
    ++predicted;
    off += *v.ratio > no_model_error;
  }
  if (predicted > 0)
    all.push_back(fmt::format("{} of {} predicted values lie within {:g} u_val of the measured ones.", predicted - off,
                              predicted, no_model_error));
  return all;
}

}  // namespace springproof
