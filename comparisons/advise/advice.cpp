#include "comparisons/advise/advice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "msm/parameters/model_table.h"

namespace springproof {
namespace {

std::string row_of(const std::string& label) { return label.substr(0, label.find(' ')); }

/// Costs of models on this machine, each measured when it is first asked for.
class Costs {
 public:
  explicit Costs(const Forecast& forecast) : forecast_(forecast) {
    if (forecast.solved_cells > 0)
      scale_ = forecast.solved_seconds / speed_of(pilot_reference_model).solve_seconds(forecast.solved_cells);
  }

  Choice of(const std::string& label, const Resolution& r, const Prediction& p, const Wish& wish) {
    Choice c{label, r, p, {}, 0, 0, 0, p.error <= wish.error, true};
    const Speed& speed = speed_of(label);
    c.seconds = (row_of(label).starts_with("fem_") ? 1 : scale_) * speed.solve_seconds(r.cells);
    c.MiB = speed.MiB_per_cell * r.cells;
    // Steps are measured in the kernels of whole cubes, which cut cells do not have.
    if (speed.step_per_cell > 0 && !is_cut(label)) {
      c.ms_per_step = 1e3 * speed.step_per_cell * r.cells;
      c.safe_step = speed.safe_step * r.edge;
    }
    c.affordable = speed.failure.empty() &&
                   (!wish.ms_per_step || (c.ms_per_step && *c.ms_per_step <= *wish.ms_per_step)) &&
                   (!wish.seconds || c.seconds <= *wish.seconds) && (!wish.MiB || c.MiB <= *wish.MiB);
    return c;
  }

  /// Of a body of voxels: in cut cells.
  bool is_cut(const std::string& label) const {
    return std::find(forecast_.models.begin(), forecast_.models.end(), label + " cut=false") != forecast_.models.end();
  }

 private:
  const Speed& speed_of(const std::string& label) {
    const std::string row = row_of(label);
    const auto at = speeds_.find(row);
    if (at != speeds_.end()) return at->second;
    return speeds_[row] = row.starts_with("fem_") ? speed_of_element(row.substr(4), forecast_.material)
                                                  : speed_of_model(row, forecast_.material);
  }

  const Forecast& forecast_;
  std::map<std::string, Speed> speeds_;
  double scale_ = 1;  ///< time of a solve of this body over that of a block of as many cells
};

/// The coarsest resolution from which on every finer one is accurate (some models are right by coincidence at one);
/// else the most accurate that is affordable, else the coarsest.
std::optional<Choice> choose(const Forecast& f, const std::string& model, const Wish& wish, Costs& costs) {
  std::optional<Choice> best, reached;
  std::vector<Choice> all;
  for (const Resolution& r : f.resolutions)
    if (const auto p = f.predict(model, r)) all.push_back(costs.of(model, r, *p, wish));
  for (auto c = all.rbegin(); c != all.rend() && c->accurate; ++c) reached = *c;
  if (reached && reached->affordable) return reached;
  for (const Choice& c : all)
    if (c.affordable && (!best || c.prediction.error <= best->prediction.error)) best = c;
  if (best) {
    best->accurate = false;  // a finer one is not, or it would have been taken
    return best;
  }
  return reached ? reached : all.empty() ? std::nullopt : std::optional(all.front());
}

/// At the one resolution asked for, or the nearest that there is.
std::optional<Choice> choose_at(const Forecast& f, const std::string& model, const Wish& wish, Costs& costs) {
  const Resolution* nearest = nullptr;
  for (const Resolution& r : f.resolutions)
    if (!nearest ||
        std::abs(std::log(r.across / *wish.cells_across)) < std::abs(std::log(nearest->across / *wish.cells_across)))
      nearest = &r;
  if (!nearest) return {};
  const auto p = f.predict(model, *nearest);
  return p ? std::optional(costs.of(model, *nearest, *p, wish)) : std::nullopt;
}

std::string percent(double x) { return x < 0.1 ? fmt::format("{:.2g} %", 100 * x) : fmt::format("{:.3g} %", 100 * x); }

std::string place(const Resolution& r) {
  return r.across > 0 ? fmt::format("{:.3g} cells across ({:.3g} cells)", r.across, r.cells)
                      : fmt::format("{:.3g} cells of {:.3g} m", r.cells, r.edge);
}

double cost_of(const Choice& c, const Wish& wish) {
  return wish.ms_per_step && c.ms_per_step ? *c.ms_per_step : c.seconds;
}

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

/// Finite elements of the measurements that reach the error.
std::vector<Choice> choose_elements(const Forecast& f, const Wish& wish, Costs& costs) {
  std::vector<Choice> out;
  Wish still = wish;  // finite elements make no explicit steps
  still.ms_per_step.reset();
  for (const char* element : {"fem_q2", "fem_q1"})
    for (const Resolution& r : f.resolutions) {
      const auto p = f.predict_element(element, r);
      if (!p || p->error > wish.error) continue;
      out.push_back(costs.of(element, r, *p, still));
      break;
    }
  std::erase_if(out, [](const Choice& c) { return c.seconds == 0; });
  return out;
}

void say(Advice& a) {
  const Wish& w = a.wish;
  const Choice* best =
      a.choices.empty() || !a.choices.front().accurate || !a.choices.front().affordable ? nullptr : &a.choices.front();
  const Choice* element = a.elements.empty() ? nullptr : &a.elements.front();
  const auto element_words = [&] {
    return fmt::format("{} elements, {}, reach {} in {:.2g} s and {:.2g} MiB",
                       element->model == "fem_q2" ? "quadratic finite" : "linear (B-bar) finite",
                       place(element->resolution), percent(element->prediction.error), element->seconds, element->MiB);
  };
  if (best) {
    a.words.push_back(fmt::format(
        "Take {} with {}: error {} ({} to {}), {}{:.2g} s per static solve.", best->model, place(best->resolution),
        percent(best->prediction.error), percent(best->prediction.error / best->prediction.factor),
        percent(best->prediction.error * best->prediction.factor),
        best->ms_per_step
            ? fmt::format("{:.3g} ms per step (steps up to {:.2g} s), ", *best->ms_per_step, best->safe_step)
            : "",
        best->seconds));
    if (best->prediction.error * best->prediction.factor > w.error)
      a.words.push_back("The error may be more than you want: its range ends above it.  One step finer is safer.");
    if (element && !w.ms_per_step && element->affordable && element->seconds < best->seconds)
      a.words.push_back(
          fmt::format("For a single static solve a mass-spring model is the slower tool: {}.", element_words()));
  } else {
    std::string closest = "none has a prediction";
    if (!a.choices.empty())
      closest = fmt::format("the closest, {} with {}, is off by {}{}", a.choices.front().model,
                            place(a.choices.front().resolution), percent(a.choices.front().prediction.error),
                            a.choices.front().affordable ? "" : " and over the budget");
    a.words.push_back(fmt::format("No mass-spring model reaches {} within the budget ({}): {}.", percent(w.error),
                                  budget_words(w), closest));
    a.words.push_back(
        element && element->affordable ? fmt::format("A mass-spring model is the wrong tool here: {}.", element_words())
        : element ? fmt::format("Finite elements need more than the budget, too: {}.", element_words())
                  : "Finite elements for this body: springproof compare runs q2, p2 on it ([compare] elements).");
  }
  if (a.forecast.load == "bending" && best && best->resolution.across > 0 && best->resolution.across < 2)
    a.words.push_back("One cell across bends by its hourglass springs alone.");
  if (std::any_of(a.choices.begin(), a.choices.end(), [](const Choice& c) { return row_of(c.model) == "msm_18"; }) &&
      !same_poisson_ratio(a.forecast.material.poisson_ratio, 0.25))
    a.words.push_back("msm_18 is a solid of nu = 1/4: its error does not fall with the cells.");
}

}  // namespace

Advice advise(const Forecast& forecast, const Wish& wish) {
  Advice out;
  out.forecast = forecast;
  out.wish = wish;
  out.machine = this_machine();
  Costs costs(out.forecast);
  for (const std::string& model : forecast.models) {
    if (!wish.models.empty() && std::find(wish.models.begin(), wish.models.end(), row_of(model)) == wish.models.end())
      continue;
    const auto c =
        wish.cells_across ? choose_at(out.forecast, model, wish, costs) : choose(out.forecast, model, wish, costs);
    if (c) out.choices.push_back(*c);
  }
  const auto rank = [&](const Choice& c) {
    return c.accurate && c.affordable ? std::pair(0, cost_of(c, wish))
                                      : std::pair(c.affordable ? 1 : 2, c.prediction.error);
  };
  std::stable_sort(out.choices.begin(), out.choices.end(),
                   [&](const Choice& a, const Choice& b) { return rank(a) < rank(b); });
  out.elements = choose_elements(out.forecast, wish, costs);
  say(out);
  return out;
}

std::string text_of(const Advice& a) {
  std::string text =
      fmt::format("{}\nwanted: error {}, budget {}\npredicted from: {}\ntimes: {}\n\n", a.forecast.geometry,
                  percent(a.wish.error), budget_words(a.wish), a.forecast.basis, a.machine);
  text += fmt::format("{:<22}{:>10}{:>9}{:>9}  {:<18}{:>10}{:>11}{:>9}{:>9}\n", "", "cells", "across", "error",
                      "9 of 10 within", "ms/step", "step s", "solve s", "MiB");
  const auto line = [&](const Choice& c) {
    const Prediction& p = c.prediction;
    text +=
        fmt::format("{:<22}{:>10.6g}{:>9}{:>9}  {:<18}{:>10}{:>11}{:>9.2g}{:>9.3g}  {}{}\n", c.model,
                    c.resolution.cells, c.resolution.across > 0 ? fmt::format("{:.3g}", c.resolution.across) : "",
                    percent(p.error), fmt::format("{} - {}", percent(p.error / p.factor), percent(p.error * p.factor)),
                    c.ms_per_step ? fmt::format("{:.3g}", *c.ms_per_step) : "-",
                    c.ms_per_step ? fmt::format("{:.2g}", c.safe_step) : "-", c.seconds, c.MiB,
                    c.accurate && !c.affordable ? "over the budget"
                    : c.accurate ? p.factor > 10 && p.error * p.factor > a.wish.error ? "uncertain" : "reaches it"
                    : p.error <= a.wish.error ? "by coincidence: finer lattices do not"
                                              : "does not reach it",
                    p.beyond ? ", extrapolated" : "");
  };
  for (const Choice& c : a.choices) line(c);
  for (const Choice& c : a.elements) line(c);
  text += "\n";
  for (const std::string& w : a.words) text += w + "\n";
  for (const std::string& n : a.forecast.notes) text += "note: " + n + "\n";
  return text;
}

nlohmann::json json_of(const Advice& a) {
  const auto number = [](const std::optional<double>& x) { return x ? nlohmann::json(*x) : nlohmann::json(); };
  const auto of_choices = [&](const std::vector<Choice>& choices) {
    nlohmann::json all = nlohmann::json::array();
    for (const Choice& c : choices)
      all.push_back({{"model", c.model},
                     {"cells", c.resolution.cells},
                     {"cells_across", c.resolution.across > 0 ? nlohmann::json(c.resolution.across) : nlohmann::json()},
                     {"edge_m", c.resolution.edge},
                     {"error", c.prediction.error},
                     {"error_factor", c.prediction.factor},
                     {"extrapolated", c.prediction.beyond},
                     {"ms_per_step", number(c.ms_per_step)},
                     {"safe_step_s", c.ms_per_step ? nlohmann::json(c.safe_step) : nlohmann::json()},
                     {"seconds_per_solve", c.seconds},
                     {"memory_MiB", c.MiB},
                     {"reaches", c.accurate},
                     {"within_budget", c.affordable}});
    return all;
  };
  nlohmann::json out = {{"what", a.forecast.geometry},
                        {"basis", a.forecast.basis},
                        {"machine", a.machine},
                        {"wanted",
                         {{"error", a.wish.error},
                          {"ms_per_step", number(a.wish.ms_per_step)},
                          {"seconds_per_solve", number(a.wish.seconds)},
                          {"memory_MiB", number(a.wish.MiB)}}},
                        {"models", of_choices(a.choices)},
                        {"finite_elements", of_choices(a.elements)},
                        {"words", a.words},
                        {"notes", a.forecast.notes}};
  if (const auto& s = a.forecast.shares)
    out["strain_energy"] = {{"bending", s->bending},
                            {"torsion", s->torsion},
                            {"axial", s->axial},
                            {"shear", s->shear},
                            {"local", s->local}};
  return out;
}

}  // namespace springproof
