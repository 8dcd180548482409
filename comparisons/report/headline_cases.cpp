#include "comparisons/report/headline_cases.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "comparisons/report/headline_words.h"
#include "comparisons/report/results.h"

namespace springproof {
namespace {

using namespace words;

// A reference with a larger uncertainty is reported as doubtful before the results of the models.
constexpr double doubtful_uncertainty = 0.05;
// A reference with a smaller uncertainty is accepted even if its grids do not converge.
constexpr double harmless_uncertainty = 0.01;

// Of the moments of inertia of a model in free flight, above the body's.
constexpr double telling_inertia = 0.02;

// Beyond these linear theory itself has errors of some per cent.
constexpr double largest_linear_strain = 0.05, largest_linear_rotation_deg = 5;

bool has_models(const Json& result) { return !list_of(object_of(result, "experiment"), "models").empty(); }
std::string name_of(const Json& result) { return string_of(object_of(result, "experiment"), "name"); }
bool is_linear(const Json& result) { return string_of(object_of(result, "experiment"), "kinematics") == "linear"; }

/// The element that the models are compared with; empty: none was requested.
std::string reference_element_of(const Json& result) {
  const Json& elements = list_of(object_of(object_of(result, "experiment"), "reference"), "elements");
  return elements.empty() ? "" : elements.front().get<std::string>();
}

template <class Holds>
bool any_of(const Json& list, Holds holds) {
  return std::any_of(list.begin(), list.end(), holds);
}

// ---- the reference

struct Doubt {
  std::size_t case_number = 0;
  std::string where, of;
  double uncertainty = 0;
  bool diverges = false;
};

void add_doubts(const Json& result, std::size_t case_number, std::vector<Doubt>& doubts) {
  if (!has_models(result)) return;
  const auto add = [&](const Json& item, const char* of, double uncertainty, bool diverges) {
    if (!(uncertainty > (diverges ? harmless_uncertainty : doubtful_uncertainty))) return;
    const std::string where = at_nu(name_of(result), number_of(item, "poisson_ratio"));
    const auto known = std::find_if(doubts.begin(), doubts.end(), [&](const Doubt& d) { return d.where == where; });
    Doubt& doubt = known == doubts.end() ? doubts.emplace_back() : *known;
    if (uncertainty >= doubt.uncertainty) doubt = {case_number, where, of, uncertainty, diverges || doubt.diverges};
    doubt.diverges = doubt.diverges || diverges;
  };
  const std::string element = reference_element_of(result);
  for (const Json& record : list_of(result, "references"))
    if (string_of(record, "measure") == "displacement_error" && string_of(record, "element") == element)
      add(record, "displacement", number_of(record, "uncertainty").value_or(0),
          string_of(record, "note").find("not converg") != std::string::npos);
  for (const Json& row : list_of(result, "rows"))
    for (const auto& [measure, of] :
         {std::pair("reaction_error", "reactions of moved supports"), {"motion_error", "motion in time"}})
      if (string_of(row, "measure") == measure)
        add(row, of, number_of(row, "reference_uncertainty").value_or(0), false);
}

std::string reason_of_missing_reference(const Json& result, const Json& nu) {
  const std::string element = reference_element_of(result);
  for (const Json& run : list_of(result, "runs"))
    if (run.at("poisson_ratio") == nu && string_of(run, "model") == "fem_" + element && !run.value("ok", false))
      return string_of(run, "message");
  return "";
}

void add_missing_references(const Json& result, std::vector<std::string>& lines) {
  for (const Json& run : list_of(result, "runs"))
    if (string_of(run, "model") == fem_in_motion && !run.value("ok", false))
      lines.push_back(fmt::format("{}: there is no reference in time: {}",
                                  at_nu(name_of(result), number_of(run, "poisson_ratio").value_or(0)),
                                  string_of(run, "message")));
  const std::string element = reference_element_of(result);
  if (element.empty()) return;
  for (const Json& nu : list_of(object_of(result, "experiment"), "poisson_ratios")) {
    const auto is_of = [&](const Json& r) { return r.at("poisson_ratio") == nu && string_of(r, "element") == element; };
    if (any_of(list_of(result, "references"), is_of)) continue;
    const std::string reason = reason_of_missing_reference(result, nu);
    lines.push_back(fmt::format("{}: there is no reference{}", at_nu(name_of(result), nu.get<double>()),
                                reason.empty() ? "" : ": " + reason));
  }
}

// ---- what was compared

bool every_run_failed(const Json& result) {
  int runs = 0, good = 0;
  for (const Json& run : list_of(result, "runs")) {
    if (string_of(run, "kind") != "msm") continue;
    ++runs;
    good += run.value("ok", false);
  }
  return runs > 0 && good == 0;
}

/// Whether nothing moves in the reference: no error can be stated relative to it, and zeros alone agree with it.
bool is_at_rest(const Json& result) {
  const Json& deformations = list_of(result, "deformations");
  const auto deforms = [](const Json& d) {
    return number_of(d, "principal_strain") != 0.0 || number_of(d, "rotation_deg") != 0.0;
  };
  const auto moves = [](const Json& row) {
    return string_of(row, "measure") == "displacement_error" && number_of(row, "error").has_value();
  };
  return !deformations.empty() && !any_of(deformations, deforms) && !any_of(list_of(result, "rows"), moves);
}

bool anything_compared(const Json& result) {
  const auto has_error = [](const Json& row) { return number_of(row, "error").has_value(); };
  return !list_of(result, "histories").empty() || !list_of(result, "cracks").empty() ||
         (!is_at_rest(result) && any_of(list_of(result, "rows"), has_error)) ||
         any_of(list_of(result, "checks"),
                [](const Json& check) { return number_of(check, "computed").has_value(); }) ||
         any_of(list_of(result, "published"), [](const Json& p) { return number_of(p, "computed").has_value(); });
}

// ---- the reference against what is known

std::string error_text(std::optional<double> computed, std::optional<double> target) {
  if (!computed || !target) return "";
  if (*target == 0) return minus(fmt::format("{:+.2g}", *computed));
  return minus(fmt::format("{:+.2g} %", 100 * (*computed / *target - 1)));
}

std::string unit_text(const Json& item) {
  const std::string unit = string_of(item, "unit");
  return unit == "1" ? "" : " " + unit;
}

std::string value_text(std::optional<double> x) { return x ? minus(fmt::format("{:.6g}", *x)) : "no result"; }

std::string verification_line(const std::string& name, const Json& item, std::optional<double> target,
                              const std::string& verdict) {
  const auto computed = number_of(item, "computed"), uncertainty = number_of(item, "reference_uncertainty");
  const bool bound = item.value("at_least", false);
  const std::string what = fmt::format("{}, {} at ν = {}", string_of(item, "model"), string_of(item, "measure"),
                                       nu_text(number_of(item, "poisson_ratio")));
  const std::string value =
      value_text(computed) + (uncertainty && !bound ? fmt::format(" ± {:.2g}", *uncertainty) : "") + unit_text(item);
  return fmt::format("{:<44} {:<52} {:<30} target {:<12} {:<12} {}", name, what, value,
                     (bound ? "≥ " : "") + value_text(target), bound ? "" : error_text(computed, target), verdict);
}

}  // namespace

std::optional<Warning> doubt_of_reference(const Json& cases) {
  std::vector<Doubt> doubts;
  for (std::size_t i = 0; i < cases.size(); ++i) add_doubts(cases[i], i, doubts);
  if (doubts.empty()) return {};
  const auto worst = std::max_element(doubts.begin(), doubts.end(),
                                      [](const Doubt& a, const Doubt& b) { return a.uncertainty < b.uncertainty; });
  const bool diverges = std::any_of(doubts.begin(), doubts.end(), [](const Doubt& d) { return d.diverges; });
  const std::string more = doubts.size() > 1 ? fmt::format(" and {} more", doubts.size() - 1) : "";
  return Warning{
      worst->case_number,
      fmt::format("The reference {} ({}{}): its {} {} uncertain by {}{} %.",
                  diverges ? "does not converge" : "is not sharp", worst->where, more, worst->of,
                  worst->of.ends_with("s") ? "are" : "is", more.empty() ? "" : "up to ", percent(worst->uncertainty)),
      ""};
}

std::string deformation_line(const Json& result) {
  std::vector<std::string> parts;
  for (const Json& d : list_of(result, "deformations")) {
    const double strain = number_of(d, "principal_strain").value_or(0);
    parts.push_back(fmt::format("ν = {}: {} %, {:.2g}°", nu_text(number_of(d, "poisson_ratio")),
                                strain < 1e-5 ? fmt::format("{:.2g}", 100 * strain) : percent(strain),
                                number_of(d, "rotation_deg").value_or(0)));
  }
  return parts.empty() ? "" : fmt::format("{:<28} {}", name_of(result), fmt::join(parts, "; "));
}

std::vector<std::string> motion_lines(const Json& result) {
  std::vector<std::string> lines;
  for (const Json& h : list_of(result, "histories")) {
    const Json measured = h.value("measured", Json::object());
    std::string line = fmt::format("{}: {} at ν = {}, {}: {}, steps of {:.3g} s", name_of(result),
                                   string_of(h, "model"), nu_text(number_of(h, "poisson_ratio")), cells_words(h),
                                   string_of(h, "integrator"), number_of(h, "time_step").value_or(0));
    if (const auto period = number_of(measured, "period"))
      line += fmt::format("; {} swings with a period of {:.5g} s and an amplitude of {:.4g} m", string_of(h, "probe"),
                          *period, number_of(measured, "amplitude").value_or(0));
    if (const auto error = number_of(measured, "motion_error"))
      line += fmt::format("; in time {} % from FEM", percent(*error));
    if (const auto uncertainty = number_of(measured, "uncertainty"))
      line += fmt::format("; uncertain by {} % in time", percent(*uncertainty));
    if (const auto drift = number_of(measured, "energy_drift"))
      line += fmt::format("; energy within {:.1e} of the largest kinetic energy", *drift);
    if (const auto arrival = number_of(measured, "arrival"))
      line += fmt::format("; {} moves after {:.4g} s", string_of(h, "probe"), *arrival);
    if (const auto contact = number_of(measured, "contact_time")) {
      const double left = number_of(measured, "restitution").value_or(0);
      line += fmt::format(
          "; touches the plane for {:.4g} s and {}", *contact,
          left > 0 ? fmt::format("leaves with {} % of its velocity", percent(left)) : "turns, still on its way to it");
    }
    if (const auto ratio = number_of(measured, "damping_ratio"))
      line += fmt::format("; damped by {} % of critical", percent(*ratio));
    if (const auto drift = number_of(measured, "momentum_drift"))
      line += fmt::format("; momentum within {:.1e}", *drift);
    if (const auto drift = number_of(measured, "angular_momentum_drift"))
      line += fmt::format("; angular momentum within {:.1e}", *drift);
    if (const auto excess = number_of(measured, "inertia_excess"); excess && *excess > telling_inertia)
      line += fmt::format(
          "; its masses at corners of cells turn with up to {} % more inertia than the body "
          "(more cells, or mass_consistency in explicit steps)",
          percent(*excess));
    lines.push_back(line);
  }
  return lines;
}

std::optional<Warning> deformation_warning(const Json& result, std::size_t case_number) {
  if (!has_models(result) || !is_linear(result)) return {};
  double strain = 0, rotation = 0;
  for (const Json& d : list_of(result, "deformations")) {
    strain = std::max(strain, number_of(d, "principal_strain").value_or(0));
    rotation = std::max(rotation, number_of(d, "rotation_deg").value_or(0));
  }
  const double factor = std::max(strain / largest_linear_strain, rotation / largest_linear_rotation_deg);
  if (factor <= 1) return {};
  const double step = std::pow(10, std::floor(std::log10(factor)) - 1);
  std::vector<std::string> sizes, limits;
  const auto compare = [&](double size, double limit, const std::string& text, const std::string& limit_text) {
    if (size <= limit) return;
    sizes.push_back(text);
    limits.push_back(limit_text);
  };
  compare(strain, largest_linear_strain, fmt::format("principal strains of {} %", percent(strain)), "5 %");
  compare(rotation, largest_linear_rotation_deg, fmt::format("rotations of {:.2g}°", rotation), "5°");
  return Warning{
      case_number,
      fmt::format("{}: {} are too large for linear theory (up to {})", name_of(result), listed(sizes), listed(limits)),
      fmt::format("divide the load by at least {:.6g}, or set kinematics = \"hencky\" (or another "
                  "finite-strain law)",
                  std::ceil(factor / step - 1e-9) * step)};
}

std::vector<std::string> failures_of(const Json& result) {
  std::vector<std::string> lines;
  add_missing_references(result, lines);
  if (!has_models(result)) return lines;
  if (every_run_failed(result)) lines.push_back(name_of(result) + ": no model has a result");
  if (lines.empty() && !anything_compared(result))
    lines.push_back(
        fmt::format("{}: nothing was compared{}", name_of(result),
                    reference_element_of(result).empty()
                        ? ", since the case asks for no reference ([reference] elements = []) and has no [[expect]] or "
                          "[[published]]"
                    : is_at_rest(result) ? ", since nothing moves in the reference: every load is zero, or acts where "
                                           "the body is held"
                                         : ": no measure of a model has a reference, an expectation or a published "
                                           "value"));
  return lines;
}

std::vector<std::string> verification_lines(const Json& result) {
  std::vector<std::string> lines;
  if (has_models(result)) return lines;
  for (const Json& check : list_of(result, "checks"))
    lines.push_back(
        verification_line(name_of(result), check, number_of(check, "expected"), string_of(check, "verdict")));
  for (const Json& p : list_of(result, "published"))
    lines.push_back(verification_line(name_of(result), p, number_of(p, "published"), "shown, not judged"));
  return lines;
}

}  // namespace springproof
