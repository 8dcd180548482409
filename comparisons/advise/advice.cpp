#include "comparisons/advise/advice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "msm/parameters/model_table.h"

namespace springproof {
namespace {

constexpr double same_error = 0.99;  // of another, which is no larger than this share of it

std::string row_of(const std::string& label) { return label.substr(0, label.find(' ')); }

bool is_element(const std::string& label) { return label.starts_with("fem_"); }

Budget budget_of(const Choice& c, const Wish& wish) {
  using Cost = std::optional<double>;
  Budget out = Budget::within;
  for (const auto& [limit, cost] :
       {std::pair<Cost, Cost>{wish.ms_per_step, c.ms_per_step}, {wish.seconds, c.seconds}, {wish.MiB, c.MiB}}) {
    if (limit && cost && *cost > *limit) return Budget::over;
    if (limit && !cost) out = Budget::unknown;
  }
  return out;
}

/// The Poisson's ratio of the only solid that a model is, if another one is wanted.
std::optional<double> other_ratio(const Forecast& f, const std::string& label) {
  const auto own = is_element(label) ? std::nullopt : own_poisson_ratio(resolve({row_of(label), {}, label, {}}).row);
  const bool fits = own && std::ranges::all_of(f.materials, [&](const IsotropicMaterial& m) {
                      return same_poisson_ratio(m.poisson_ratio, *own);
                    });
  return fits ? std::nullopt : own;
}

/// Costs of models on this machine, each measured when it is first asked for.
class Costs {
 public:
  explicit Costs(const Forecast& forecast) : forecast_(forecast) {
    if (forecast.solved_cells > 0)
      scale_ = forecast.solved_seconds / speed_of(pilot_reference_model).solve_seconds(forecast.solved_cells);
  }

  Choice of(const std::string& label, const Resolution& r, const Prediction& p, const Wish& wish) {
    Choice c{label, r, p, {}, 0, {}, {}, "", other_ratio(forecast_, label), p.error <= wish.error, Budget::within};
    const Speed& speed = speed_of(label);
    if (speed.failure.empty()) {
      const auto made = forecast_.making.find(label);
      c.seconds = (is_element(label) ? 1 : scale_) * speed.solve_seconds(r.cells) +
                  (made == forecast_.making.end() ? 0 : made->second * r.cells);
      c.MiB = speed.MiB_per_cell * r.cells;
    }
    c.unmeasured = speed.failure;
    if (const StepCost& step = step_of(label, speed); step.seconds_per_cell > 0) {
      c.ms_per_step = 1e3 * step.seconds_per_cell * r.cells;
      c.safe_step = step.safe_step * r.edge;
    } else if (c.unmeasured.empty()) {
      c.unmeasured = step.failure;
    }
    c.budget = budget_of(c, wish);
    return c;
  }

 private:
  const StepCost& step_of(const std::string& label, const Speed& speed) const {
    const auto cut = forecast_.cut_steps.find(label);
    return cut == forecast_.cut_steps.end() ? speed.step : cut->second;
  }

  const Speed& speed_of(const std::string& label) {
    const std::string row = row_of(label);
    const auto at = speeds_.find(row);
    if (at != speeds_.end()) return at->second;
    return speeds_[row] = is_element(row) ? speed_of_element(row.substr(4), forecast_.material)
                                          : speed_of_model(row, forecast_.material);
  }

  const Forecast& forecast_;
  std::map<std::string, Speed> speeds_;
  double scale_ = 1;  ///< time of a solve of this body over that of a block of as many cells
};

/// A model on all lattices, ascending.  Some models are right by coincidence on one lattice: the error is the largest
/// of it and all finer ones.
std::vector<Choice> all_of(const Forecast& f, const std::string& model, const Wish& wish, Costs& costs) {
  std::vector<Choice> all;
  double largest = 0;
  for (auto r = f.resolutions.rbegin(); r != f.resolutions.rend(); ++r)
    if (auto p = f.predict(model, *r)) {
      largest = p->error = std::max(p->error, largest);
      all.insert(all.begin(), costs.of(model, *r, *p, wish));
    }
  return all;
}

/// The coarsest lattice that is accurate; else the coarsest of the most accurate that are not over the budget, else the
/// coarsest.
std::optional<Choice> choose(const std::vector<Choice>& all) {
  const auto reached = std::ranges::find_if(all, [](const Choice& c) { return c.accurate; });
  if (reached != all.end() && reached->budget != Budget::over) return *reached;
  std::optional<Choice> best;
  for (const Choice& c : all)
    if (c.budget != Budget::over && (!best || c.prediction.error < same_error * best->prediction.error)) best = c;
  if (best) return best;
  return reached != all.end() ? std::optional(*reached) : all.empty() ? std::nullopt : std::optional(all.front());
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

double largest_error(const Choice& c) { return c.prediction.error * c.prediction.factor; }

/// Where the range of the first choice ends above the error: its model on the coarsest lattice where it ends below.
std::optional<Choice> safer_than(const Choice& best, const Forecast& f, const Wish& wish, Costs& costs) {
  if (!best.suits() || largest_error(best) <= wish.error) return {};
  for (const Choice& c : all_of(f, best.model, wish, costs))
    if (c.resolution.cells > best.resolution.cells && c.suits() && largest_error(c) <= wish.error) return c;
  return {};
}

/// Finite elements that reach the error, coarsest each.
std::vector<Choice> choose_elements(const Forecast& f, const Wish& wish, Costs& costs) {
  std::vector<Choice> out;
  Wish still = wish;  // finite elements make no explicit steps
  still.ms_per_step.reset();
  for (const char* element : {"fem_q2", "fem_q1"})
    for (const Resolution& r : f.resolutions) {
      const auto p = f.predict(element, r);
      if (!p || p->error > wish.error) continue;
      out.push_back(costs.of(element, r, *p, still));
      break;
    }
  std::erase_if(out, [](const Choice& c) { return !c.seconds; });
  return out;
}

double cost_of(const Choice& c, const Wish& wish) {
  return wish.ms_per_step && c.ms_per_step ? *c.ms_per_step : c.seconds.value_or(HUGE_VAL);
}

/// What suits by its cost, what may, what is affordable by its error, what is not; last what is another solid.
std::pair<int, double> rank_of(const Choice& c, const Wish& wish) {
  if (c.suits()) return {0, cost_of(c, wish)};
  const int group = c.own_ratio ? 4 : c.budget == Budget::over ? 3 : c.accurate ? 1 : 2;
  return {group, c.prediction.error};
}

}  // namespace

Advice advise(const Forecast& forecast, const Wish& wish) {
  Advice out;
  out.forecast = forecast;
  out.wish = wish;
  const std::string processor = processor_name();
  out.machine = (processor.empty() ? "this machine" : processor) + ", one core";
  Costs costs(out.forecast);
  for (const std::string& model : forecast.models) {
    if (!wish.models.empty() && std::ranges::find(wish.models, row_of(model)) == wish.models.end()) continue;
    const auto c = wish.cells_across ? choose_at(out.forecast, model, wish, costs)
                                     : choose(all_of(out.forecast, model, wish, costs));
    if (c) out.choices.push_back(*c);
  }
  std::ranges::stable_sort(out.choices,
                           [&](const Choice& a, const Choice& b) { return rank_of(a, wish) < rank_of(b, wish); });
  if (!out.choices.empty() && !wish.cells_across)
    out.safer = safer_than(out.choices.front(), out.forecast, wish, costs);
  out.elements = choose_elements(out.forecast, wish, costs);
  out.words = words_of(out);
  return out;
}

}  // namespace springproof
