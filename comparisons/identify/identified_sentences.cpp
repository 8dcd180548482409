#include "comparisons/identify/identified_sentences.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "comparisons/identify/least_squares.h"
#include "comparisons/judge/validation.h"

namespace springproof {
namespace {

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
