#include "comparisons/report/headline_cases.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "comparisons/report/words.h"

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

bool has_models(const CaseResult& result) { return !result.experiment.models.empty(); }
const std::string& name_of(const CaseResult& result) { return result.experiment.name; }

/// The element that the models are compared with; empty: none was requested.
std::string reference_element_of(const CaseResult& result) {
  const auto& elements = result.experiment.reference.elements;
  return elements.empty() ? "" : elements.front();
}

bool is_number(const std::optional<double>& x) { return x && std::isfinite(*x); }

// ---- the reference

struct Doubt {
  std::size_t case_number = 0;
  std::string where, of;
  double uncertainty = 0;
  bool diverges = false;
};

void add_doubts(const CaseResult& result, std::size_t case_number, std::vector<Doubt>& doubts) {
  if (!has_models(result)) return;
  const auto add = [&](double nu, const char* of, double uncertainty, bool diverges) {
    if (!(uncertainty > (diverges ? harmless_uncertainty : doubtful_uncertainty))) return;
    const std::string where = at_setting(result.experiment, name_of(result), nu);
    const auto known = std::ranges::find_if(doubts, [&](const Doubt& d) { return d.where == where; });
    Doubt& doubt = known == doubts.end() ? doubts.emplace_back() : *known;
    if (uncertainty >= doubt.uncertainty) doubt = {case_number, where, of, uncertainty, diverges || doubt.diverges};
    doubt.diverges = doubt.diverges || diverges;
  };
  const std::string element = reference_element_of(result);
  for (const ReferenceRecord& r : result.references)
    if (r.measure == "displacement_error" && r.element == element)
      add(r.poisson_ratio, "displacement", r.uncertainty, !r.converging);
  for (const Row& row : result.rows)
    for (const auto& [measure, of] :
         {std::pair("reaction_error", "reactions of moved supports"), {"motion_error", "motion in time"}})
      if (row.measure == measure) add(row.poisson_ratio, of, row.reference_uncertainty.value_or(0), false);
}

std::string reason_of_missing_reference(const CaseResult& result, double nu) {
  const std::string element = reference_element_of(result);
  for (const Run& run : result.runs)
    if (run.poisson_ratio == nu && run.model == "fem_" + element && !run.ok) return run.message;
  return "";
}

void add_missing_references(const CaseResult& result, std::vector<std::string>& lines) {
  for (const Run& run : result.runs)
    if (run.model == fem_in_motion && !run.ok)
      lines.push_back(fmt::format("{}: there is no reference in time: {}",
                                  at_setting(result.experiment, name_of(result), run.poisson_ratio), run.message));
  const std::string element = reference_element_of(result);
  if (element.empty()) return;
  for (const double nu : result.experiment.settings()) {
    if (std::ranges::any_of(result.references,
                            [&](const ReferenceRecord& r) { return r.poisson_ratio == nu && r.element == element; }))
      continue;
    const std::string reason = reason_of_missing_reference(result, nu);
    lines.push_back(fmt::format("{}: there is no reference{}", at_setting(result.experiment, name_of(result), nu),
                                reason.empty() ? "" : ": " + reason));
  }
}

// ---- what was compared

bool every_run_failed(const CaseResult& result) {
  int runs = 0, good = 0;
  for (const Run& run : result.runs) {
    if (run.kind != "msm") continue;
    ++runs;
    good += run.ok;
  }
  return runs > 0 && good == 0;
}

/// Whether nothing moves in the reference: no error can be stated relative to it, and zeros alone agree with it.
bool is_at_rest(const CaseResult& result) {
  const auto deforms = [](const Deformation& d) { return d.principal_strain != 0.0 || d.rotation_deg != 0.0; };
  const auto moves = [](const Row& row) { return row.measure == "displacement_error" && is_number(row.error); };
  return !result.deformations.empty() && !std::ranges::any_of(result.deformations, deforms) &&
         !std::ranges::any_of(result.rows, moves);
}

bool anything_compared(const CaseResult& result) {
  const auto computed = [](const auto& item) { return is_number(item.computed); };
  return !result.histories.empty() || !result.cracks.empty() ||
         (!is_at_rest(result) &&
          std::ranges::any_of(result.rows, [](const Row& row) { return is_number(row.error); })) ||
         std::ranges::any_of(result.checks, computed) || std::ranges::any_of(result.published, computed) ||
         (reference_element_of(result).empty() && !result.rows.empty());  // nothing but measures was asked for
}

// ---- linear theory

/// How far a linear case with models is beyond linear theory.
struct Excess {
  double factor = 0;                       ///< by which the load is too large; up to 1: it is not
  std::vector<std::string> sizes, limits;  ///< of what is too large, in words
};

Excess excess_of(const CaseResult& result) {
  if (!has_models(result) || result.experiment.kinematics != "linear") return {};
  double strain = 0, rotation = 0;
  for (const Deformation& d : result.deformations) {
    strain = std::max(strain, d.principal_strain);
    rotation = std::max(rotation, d.rotation_deg);
  }
  Excess excess{std::max(strain / largest_linear_strain, rotation / largest_linear_rotation_deg), {}, {}};
  const auto compare = [&](double size, double limit, const std::string& text, const std::string& limit_text) {
    if (size <= limit) return;
    excess.sizes.push_back(text);
    excess.limits.push_back(limit_text);
  };
  compare(strain, largest_linear_strain, fmt::format("principal strains of {} %", percent(strain)), "5 %");
  compare(rotation, largest_linear_rotation_deg, fmt::format("rotations of {:.2g}°", rotation), "5°");
  return excess;
}

// ---- the reference against what is known

std::string error_text(const std::optional<double>& computed, double target) {
  if (!is_number(computed)) return "";
  if (target == 0) return minus(fmt::format("{:+.2g}", *computed));
  return minus(fmt::format("{:+.2g} %", 100 * (*computed / target - 1)));
}

std::string value_text(const std::optional<double>& x) {
  return is_number(x) ? minus(fmt::format("{:.6g}", *x)) : "no result";
}

/// Of a Check or a PublishedRow; `bound`: the target is one.
template <class Item>
std::string verification_line(const CaseResult& result, const Item& item, double target, double uncertainty, bool bound,
                              const std::string& verdict) {
  const std::string what =
      fmt::format("{}, {} at {}", item.model, item.measure, setting_text(result.experiment, item.poisson_ratio));
  const std::string value = value_text(item.computed) +
                            (std::isfinite(uncertainty) && !bound ? fmt::format(" ± {:.2g}", uncertainty) : "") +
                            (item.unit == "1" ? "" : " " + item.unit);
  return fmt::format("{:<44} {:<52} {:<30} target {:<12} {:<12} {}", name_of(result), what, value,
                     (bound ? "≥ " : "") + value_text(target), bound ? "" : error_text(item.computed, target), verdict);
}

}  // namespace

std::optional<Warning> doubt_of_reference(const std::vector<CaseResult>& cases) {
  std::vector<Doubt> doubts;
  for (std::size_t i = 0; i < cases.size(); ++i) add_doubts(cases[i], i, doubts);
  if (doubts.empty()) return {};
  const auto worst =
      std::ranges::max_element(doubts, [](const Doubt& a, const Doubt& b) { return a.uncertainty < b.uncertainty; });
  const bool diverges = std::ranges::any_of(doubts, [](const Doubt& d) { return d.diverges; });
  const std::string more = doubts.size() > 1 ? fmt::format(" and {} more", doubts.size() - 1) : "";
  return Warning{
      worst->case_number,
      fmt::format("The reference {} ({}{}): its {} {} uncertain by {}{} %.",
                  diverges ? "does not converge" : "is not sharp", worst->where, more, worst->of,
                  worst->of.ends_with("s") ? "are" : "is", more.empty() ? "" : "up to ", percent(worst->uncertainty)),
      ""};
}

std::string deformation_line(const CaseResult& result) {
  std::vector<std::string> parts;
  for (const Deformation& d : result.deformations)
    parts.push_back(fmt::format(
        "{}: {} %, {:.2g}°", setting_text(result.experiment, d.poisson_ratio),
        d.principal_strain < 1e-5 ? fmt::format("{:.2g}", 100 * d.principal_strain) : percent(d.principal_strain),
        d.rotation_deg));
  return parts.empty() ? "" : fmt::format("{:<28} {}", name_of(result), fmt::join(parts, "; "));
}

std::string motion_sentence(const std::vector<CaseResult>& cases, std::vector<std::string>& closest) {
  const CaseResult* of = nullptr;
  const HistoryRecord* history = nullptr;
  for (const CaseResult& result : cases)
    for (const HistoryRecord& h : result.histories) {
      const bool named = std::ranges::find(closest, h.model) != closest.end();
      if (h.model == fem_in_motion || (history && !named)) continue;
      of = &result;
      history = &h;
      if (named) break;
    }
  if (!history || history->time.empty() || !(history->time_step > 0)) return "";
  if (closest.empty()) closest.push_back(history->model);
  const double duration = history->time.back(), steps = std::round(duration / history->time_step);
  std::vector<std::string> kept;
  for (const auto& [name, words] : {std::pair("energy_drift", "energy"),
                                    {"momentum_drift", "momentum"},
                                    {"angular_momentum_drift", "angular momentum"}})
    if (const auto drift = history->measured.find(name); drift != history->measured.end())
      kept.push_back(fmt::format("its {} within {:.1e}", words, drift->second));
  std::string out =
      fmt::format("Over {:.4g} s of {}, in {:.0f} steps, {}", duration, name_of(*of), steps, history->model);
  if (!kept.empty()) out += " keeps " + listed(kept);
  const auto run = std::ranges::find_if(of->runs, [&](const Run& r) { return same_run(r, *history); });
  if (run != of->runs.end() && run->seconds > 0)
    out += fmt::format("{} {:.2g} ms of computing a step, {:.2g} s for each second of the motion",
                       kept.empty() ? " takes" : ", at", 1e3 * run->seconds / steps, run->seconds / duration);
  return out + ".";
}

std::vector<std::string> measured_lines(const CaseResult& result) {
  if (!has_models(result) || !result.experiment.reference.elements.empty() || !result.checks.empty() ||
      !result.published.empty())
    return {};
  std::map<std::string, double> finest;
  for (const Row& row : result.rows) finest[row.model] = std::max(finest[row.model], cell_count(row.cells));
  std::vector<std::string> lines;
  for (const Row& row : result.rows)
    if (cell_count(row.cells) == finest[row.model])
      lines.push_back(fmt::format("{:<44} {:<34} {:>12} {}",
                                  at_setting(result.experiment, row.model, row.poisson_ratio), row.measure,
                                  value_text(row.value), row.unit == "1" ? "" : row.unit));
  return lines;
}

std::vector<std::string> motion_lines(const CaseResult& result) {
  std::vector<std::string> lines;
  for (const HistoryRecord& h : result.histories) {
    const auto measured = [&](const char* name) -> std::optional<double> {
      const auto found = h.measured.find(name);
      return found != h.measured.end() && std::isfinite(found->second) ? std::optional(found->second) : std::nullopt;
    };
    std::string line =
        fmt::format("{}: {} at {}, {}: {}, steps of {:.3g} s", name_of(result), h.model,
                    setting_text(result.experiment, h.poisson_ratio), cells_words(h.cells), h.integrator, h.time_step);
    if (const auto period = measured("period"))
      line += fmt::format("; {} swings with a period of {:.5g} s and an amplitude of {:.4g} m", h.probe, *period,
                          measured("amplitude").value_or(0));
    if (const auto error = measured("motion_error")) line += fmt::format("; in time {} % from FEM", percent(*error));
    if (const auto uncertainty = measured("uncertainty"))
      line += fmt::format("; uncertain by {} % in time", percent(*uncertainty));
    if (const auto drift = measured("energy_drift"))
      line += fmt::format("; energy within {:.1e} of the largest kinetic energy", *drift);
    if (const auto arrival = measured("arrival")) line += fmt::format("; {} moves after {:.4g} s", h.probe, *arrival);
    if (const auto contact = measured("contact_time")) {
      const double left = measured("restitution").value_or(0);
      line += fmt::format(
          "; touches the plane for {:.4g} s and {}", *contact,
          left > 0 ? fmt::format("leaves with {} % of its velocity", percent(left)) : "turns, still on its way to it");
    }
    if (const auto ratio = measured("damping_ratio"))
      line += fmt::format("; damped by {} % of critical", percent(*ratio));
    if (const auto drift = measured("momentum_drift")) line += fmt::format("; momentum within {:.1e}", *drift);
    if (const auto drift = measured("angular_momentum_drift"))
      line += fmt::format("; angular momentum within {:.1e}", *drift);
    if (const auto excess = measured("inertia_excess"); excess && *excess > telling_inertia)
      line += fmt::format(
          "; its masses at corners of cells turn with up to {} % more inertia than the body "
          "(more cells, or mass_consistency in explicit steps)",
          percent(*excess));
    lines.push_back(line);
  }
  return lines;
}

std::optional<Warning> deformation_warning(const CaseResult& result, std::size_t case_number) {
  const Excess excess = excess_of(result);
  if (!(excess.factor > 1)) return {};
  const double step = std::pow(10, std::floor(std::log10(excess.factor)) - 1);
  return Warning{case_number,
                 fmt::format("{}: {} are too large for linear theory (up to {})", name_of(result), listed(excess.sizes),
                             listed(excess.limits)),
                 fmt::format("divide the load by at least {:.6g}, or set kinematics = \"hencky\" (or another "
                             "finite-strain law) at the top of the file",
                             std::ceil(excess.factor / step - 1e-9) * step)};
}

std::string beyond_linear_theory(const std::vector<CaseResult>& cases) {
  std::vector<std::string> beyond;
  for (const CaseResult& result : cases)
    if (const Excess excess = excess_of(result); excess.factor > 1)
      beyond.push_back(fmt::format("{} has {}", name_of(result), listed(excess.sizes)));
  return beyond.empty() ? "" : fmt::format("Linear theory does not hold here: {}.", listed(beyond));
}

std::vector<std::string> failures_of(const CaseResult& result) {
  std::vector<std::string> lines;
  add_missing_references(result, lines);
  if (!has_models(result)) return lines;
  if (every_run_failed(result)) lines.push_back(name_of(result) + ": no model has a result");
  if (lines.empty() && !anything_compared(result))
    lines.push_back(fmt::format(
        "{}: nothing was compared{}", name_of(result),
        reference_element_of(result).empty()
            ? " or measured: the case asks for no reference ([reference] elements = []), and no model has a "
              "number"
        : is_at_rest(result) ? ", since nothing moves in the reference: every load is zero, or acts where "
                               "the body is held"
                             : ": no measure of a model has a reference, an expectation or a published "
                               "value"));
  return lines;
}

std::vector<std::string> verification_lines(const CaseResult& result) {
  std::vector<std::string> lines;
  if (has_models(result)) return lines;
  for (const Check& c : result.checks)
    lines.push_back(verification_line(result, c, c.expected, c.reference_uncertainty.value_or(std::nan("")), c.at_least,
                                      to_string(c.verdict)));
  for (const PublishedRow& p : result.published)
    lines.push_back(verification_line(result, p, p.published, std::nan(""), false, "shown, not judged"));
  return lines;
}

}  // namespace springproof
