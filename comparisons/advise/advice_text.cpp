// Advice as words, a table and JSON.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "comparisons/advise/advice.h"
#include "problem/system/json.h"

namespace springproof {
namespace {

using Json = nlohmann::json;

std::string percent(double x) { return x < 0.1 ? fmt::format("{:.2g} %", 100 * x) : fmt::format("{:.3g} %", 100 * x); }

std::string range(const Prediction& p, const char* between) {
  return percent(p.error / p.factor) + between + percent(p.error * p.factor);
}

std::string place(const Resolution& r) {
  const auto cells = [](double n) { return n == 1 ? "cell" : "cells"; };
  return r.across > 0 ? fmt::format("{:.3g} {} across ({:.0f} {})", r.across, cells(r.across), r.cells, cells(r.cells))
                      : fmt::format("{:.0f} {} of {:.3g} m", r.cells, cells(r.cells), r.edge);
}

std::string or_dash(const std::optional<double>& x, int digits) { return x ? fmt::format("{:.{}g}", *x, digits) : "-"; }

std::string budget_words(const Wish& w) {
  std::string out;
  const auto add = [&](const std::optional<double>& x, const char* unit) {
    if (x) out += fmt::format("{}{:g} {}", out.empty() ? "" : ", ", *x, unit);
  };
  add(w.ms_per_step, "ms per step");
  add(w.seconds, "s per solve");
  add(w.MiB, "MiB");
  return out.empty() ? "no limit" : out;
}

std::string element_words(const Choice& c) {
  return fmt::format("{} elements, {}, reach {} in {:.2g} s and {:.2g} MiB",
                     c.model == "fem_q2" ? "quadratic finite" : "linear (B-bar) finite", place(c.resolution),
                     percent(c.prediction.error), *c.seconds, *c.MiB);
}

std::string step_words(const Choice& c) {
  return c.ms_per_step ? fmt::format("{:.3g} ms per step (steps up to {:.2g} s), ", *c.ms_per_step, c.safe_step) : "";
}

/// Of a model that suits.
void recommend(const Advice& a, const Choice& best, const Choice* element, std::vector<std::string>& words) {
  words.push_back(fmt::format("Take {} with {}: error {} ({}), {}{} s per static solve.", best.model,
                              place(best.resolution), percent(best.prediction.error), range(best.prediction, " to "),
                              step_words(best), or_dash(best.seconds, 2)));
  const std::string above = "The error may be more than you want: its range ends above it.  ";
  if (a.safer)
    words.push_back(fmt::format("{}With {} it ends below.", above, place(a.safer->resolution)));
  else if (best.prediction.error * best.prediction.factor > a.wish.error)
    words.push_back(above + "No finer lattice within the budget is known to be safe.");
  if (element && !a.wish.ms_per_step && element->budget == Budget::within && best.seconds &&
      *element->seconds < *best.seconds)
    words.push_back("For a single static solve a mass-spring model is the slower tool: " + element_words(*element) +
                    ".");
  if (a.forecast.shares.largest() == "bending" && best.resolution.across > 0 && best.resolution.across < 2)
    words.push_back("One cell across bends by its hourglass springs alone.");
}

/// Which of measuring cells and refining them costs less for the wanted error.
void weigh(const Advice& a, std::vector<std::string>& words) {
  const auto made_by = [&](const char* how) -> const Choice* {
    const auto at = std::ranges::find_if(
        a.choices, [&](const Choice& c) { return c.model.ends_with(how) && c.accurate && c.seconds; });
    return at == a.choices.end() ? nullptr : &*at;
  };
  const Choice *measured = made_by(" coarsened=true"), *refined = made_by(" accuracy");
  if (!measured || !refined) return;
  const auto cost = [](const Choice& c) {
    return fmt::format("{:.0f} cells, {:.2g} s of processor to make and solve", c.resolution.cells, *c.seconds);
  };
  words.push_back(fmt::format(
      "Measured cells (coarsened: {}) or refined ones (accuracy: {}): {} cost less{}.", cost(*measured), cost(*refined),
      *measured->seconds < *refined->seconds ? "measured ones" : "refined ones",
      measured->ms_per_step && refined->ms_per_step
          ? fmt::format(", and steps of {:.2g} s take {:.3g} ms beside {:.2g} s and {:.3g} ms", measured->safe_step,
                        *measured->ms_per_step, refined->safe_step, *refined->ms_per_step)
          : ""));
}

/// The closest of the models that are the wanted solid.
std::string closest_words(const Advice& a) {
  if (a.choices.empty() || a.choices.front().own_ratio) return "none of this solid has a prediction";
  const Choice& c = a.choices.front();
  return fmt::format("the closest, {} with {}, is off by {}{}", c.model, place(c.resolution),
                     percent(c.prediction.error), c.budget == Budget::over ? " and over the budget" : "");
}

/// Where no model suits.
void say_none(const Advice& a, const Choice* element, std::vector<std::string>& words) {
  const Choice* first = a.choices.empty() ? nullptr : &a.choices.front();
  if (first && first->accurate && !first->own_ratio && first->budget == Budget::unknown) {
    words.push_back(fmt::format("{} with {} reaches {}; whether within the budget ({}) is not known: {}", first->model,
                                place(first->resolution), percent(a.wish.error), budget_words(a.wish),
                                first->unmeasured));
    return;
  }
  words.push_back(fmt::format("No mass-spring model reaches {} within the budget ({}): {}.", percent(a.wish.error),
                              budget_words(a.wish), closest_words(a)));
  if (!element)
    words.push_back("Finite elements for this body: springproof compare runs q2, p2 on it ([compare] elements).");
  else if (element->budget == Budget::over)
    words.push_back("Finite elements need more than the budget, too: " + element_words(*element) + ".");
  else
    words.push_back("A mass-spring model is the wrong tool here: " + element_words(*element) + ".");
}

std::string verdict(const Choice& c, const Wish& wish) {
  const Prediction& p = c.prediction;
  if (c.own_ratio) return fmt::format("a solid of nu = {:g} alone", *c.own_ratio);
  if (!c.accurate) return "does not reach it";
  if (c.budget == Budget::over) return "over the budget";
  if (c.budget == Budget::unknown) return "cost not known";
  return p.factor > 10 && p.error * p.factor > wish.error ? "uncertain" : "reaches it";
}

std::string line(const Choice& c, const Wish& wish) {
  const Resolution& r = c.resolution;
  return fmt::format("{:<22}{:>10.0f}{:>9}{:>9}  {:<18}{:>10}{:>11}{:>9}{:>9}  {}{}\n", c.model, r.cells,
                     r.across > 0 ? fmt::format("{:.3g}", r.across) : "", percent(c.prediction.error),
                     range(c.prediction, " - "), or_dash(c.ms_per_step, 3),
                     c.ms_per_step ? fmt::format("{:.2g}", c.safe_step) : "-", or_dash(c.seconds, 2), or_dash(c.MiB, 3),
                     verdict(c, wish), c.prediction.beyond ? ", extrapolated" : "");
}

}  // namespace

static void to_json(Json& j, const Choice& c) {
  const auto if_there = [](bool there, double x) { return there ? std::optional(x) : std::nullopt; };
  j = {{"model", c.model},
       {"cells", std::lround(c.resolution.cells)},
       {"cells_across", if_there(c.resolution.across > 0, c.resolution.across)},
       {"edge_m", c.resolution.edge},
       {"error", c.prediction.error},
       {"error_factor", c.prediction.factor},
       {"extrapolated", c.prediction.beyond},
       {"ms_per_step", c.ms_per_step},
       {"safe_step_s", if_there(c.ms_per_step.has_value(), c.safe_step)},
       {"seconds_per_solve", c.seconds},
       {"memory_MiB", c.MiB},
       {"not_measured", c.unmeasured},
       {"own_poisson_ratio", c.own_ratio},
       {"reaches", c.accurate && !c.own_ratio},
       {"within_budget", c.budget == Budget::unknown ? Json() : Json(c.budget == Budget::within)}};
}

std::vector<std::string> words_of(const Advice& a) {
  std::vector<std::string> words;
  const Choice* element = a.elements.empty() ? nullptr : &a.elements.front();
  if (!a.choices.empty() && a.choices.front().suits())
    recommend(a, a.choices.front(), element, words);
  else
    say_none(a, element, words);
  weigh(a, words);
  return words;
}

std::string text_of(const Advice& a) {
  std::string text =
      fmt::format("{}\nwanted: error {}, budget {}\npredicted from: {}\ntimes: {}\n\n", a.forecast.geometry,
                  percent(a.wish.error), budget_words(a.wish), a.forecast.basis, a.machine);
  text += fmt::format("{:<22}{:>10}{:>9}{:>9}  {:<18}{:>10}{:>11}{:>9}{:>9}\n", "", "cells", "across", "error",
                      "9 of 10 within", "ms/step", "step s", "solve s", "MiB");
  for (std::size_t i = 0; i < a.choices.size(); ++i) {
    text += line(a.choices[i], a.wish);
    if (i == 0 && a.safer) text += line(*a.safer, a.wish);
  }
  for (const Choice& c : a.elements) text += line(c, a.wish);
  text += "\n";
  for (const std::string& w : a.words) text += w + "\n";
  for (const std::string& n : a.forecast.notes) text += "note: " + n + "\n";
  return text;
}

Json json_of(const Advice& a) {
  const LoadShares& s = a.forecast.shares;
  return {
      {"what", a.forecast.geometry},
      {"basis", a.forecast.basis},
      {"machine", a.machine},
      {"wanted",
       {{"error", a.wish.error},
        {"ms_per_step", a.wish.ms_per_step},
        {"seconds_per_solve", a.wish.seconds},
        {"memory_MiB", a.wish.MiB}}},
      {"models", a.choices},
      {"safer", a.safer},
      {"finite_elements", a.elements},
      {"words", a.words},
      {"notes", a.forecast.notes},
      {"strain_energy",
       {{"bending", s.bending}, {"torsion", s.torsion}, {"axial", s.axial}, {"shear", s.shear}, {"local", s.local}}}};
}

}  // namespace springproof
