#include "comparisons/judge/validation.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "problem/case_file/measures.h"

namespace springproof {
namespace {

using Maybe = std::optional<double>;

/// Sets S and u_num: half of the uncertainty of a limit, which is about two standard ones.
void set_limit(const LatticeValues& s, ValidatedValue& v) {
  if (s.values.empty()) return;
  v.simulated = s.values.back();
  const std::optional<ReferenceValue> limit = limit_of(s);
  if (!limit) return;
  v.simulated = limit->value;
  v.u_numerical = limit->uncertainty / 2;
  v.resolution = s.values.back() - limit->value;
}

/// Change of a simulated value by an input, on the lattice of fewest cells; empty: one of the two runs has no value.
Maybe change_by(const CaseResult& r, const MeasuredValue& m, const std::string& input) {
  const WhereComputed at{r.experiment.models.front().label, *std::ranges::min_element(r.cells, has_fewer_cells)};
  const Maybe before = simulated(r, m, "", at), after = simulated(r, m, input, at);
  return before && after && std::isfinite(*after - *before) ? Maybe(*after - *before) : Maybe();
}

/// The value f that an input was fitted to.
struct Fit {
  const MeasuredValue* value = nullptr;  ///< none: nothing was fitted
  std::string input = {};
  Maybe change = {};  ///< of f by the input
};

Fit fit_of(const CaseResult& r) {
  Fit fit;
  for (const MeasuredValue& m : r.experiment.measured)
    if (m.fitted) fit.value = &m;
  for (const UncertainInput& input : r.experiment.inputs)
    if (input.kind == UncertainInput::Kind::fitted) fit.input = input.name;
  if (fit.value) fit.change = change_by(r, *fit.value, fit.input);
  return fit;
}

/// Why no value can be judged beside this fit; empty: they can.
std::string fault_of(const Fit& fit, const ValidatedValue& f) {
  if (!f.simulated) return fmt::format("'{}', to which '{}' was fitted, has no simulated value", f.name, fit.input);
  const double u = std::hypot(f.u_numerical.value_or(0), f.u_measured);
  if (!(std::abs(*f.error) <= no_model_error * u))
    return fmt::format("'{}' is not fitted to '{}', from which the simulated value is {:.1f} u_num and u_D away",
                       fit.input, f.name, std::abs(*f.error) / u);
  if (!fit.change) return fmt::format("'{}' has no value with '{}' changed", f.name, fit.input);
  if (std::abs(*fit.change) <= solver_noise * std::abs(*f.simulated))
    return fmt::format("'{}' does not change with '{}', which was fitted to it", f.name, fit.input);
  return "";
}

/// The shares of the inputs in a value, and u_input.  A fit to another value f answers to a change of an input there:
/// what is left here is dS/dp - (dS/dp_f) / (dS_f/dp_f) dS_f/dp, where p_f is what was fitted.
void set_inputs(const CaseResult& r, const MeasuredValue& m, const Fit& fit, ValidatedValue& v) {
  const Maybe change_by_fit = fit.value ? change_by(r, m, fit.input) : 0;
  if (!change_by_fit) {
    v.not_judged = fmt::format("no value with '{}' changed", fit.input);
    return;
  }
  const double answer = fit.value ? *change_by_fit / *fit.change : 0;  // change here per change of f
  std::vector<std::string> missing;
  double squares = 0;
  const auto add = [&](const std::string& name, const Maybe& change, bool alternative) {
    v.inputs.push_back({name, change, alternative});
    if (alternative) return;
    if (!change) missing.push_back(name);
    squares += std::pow(change.value_or(0), 2);
  };
  for (const UncertainInput& input : r.experiment.inputs) {
    if (input.kind == UncertainInput::Kind::fitted) continue;
    const Maybe here = change_by(r, m, input.name), there = fit.value ? change_by(r, *fit.value, input.name) : 0;
    add(input.name, here && there ? Maybe(*here - answer * *there) : Maybe(),
        input.kind == UncertainInput::Kind::alternative);
  }
  if (fit.value) add("fit to " + fit.value->name, answer * fit.value->u, false);
  if (missing.empty())
    v.u_input = std::sqrt(squares);
  else
    v.not_judged = fmt::format("no value with '{}' changed", fmt::join(missing, "', '"));
}

/// On the finest cells where both are known.
Maybe share_of_springs(const CaseResult& r, const MeasuredValue& m, const LatticeValues& model) {
  if (r.experiment.elements.empty()) return {};
  for (std::size_t i = model.cells.size(); i-- > 0;)
    if (const Maybe fem = simulated(r, m, "", {"fem_" + r.experiment.elements.front(), model.cells[i]}))
      return model.values[i] - *fem;
  return {};
}

ValidatedValue simulated_beside(const CaseResult& r, const MeasuredValue& m) {
  const Experiment& e = r.experiment;
  ValidatedValue v =
      of_run<ValidatedValue>({e.models.front().label, e.materials.front().poisson_ratio, r.cells.front()});
  v.name = m.name;
  v.quantity = m.quantity;
  v.unit = unit_of(m.quantity);
  v.load_case = e.load_cases[m.of].name + (m.minus ? " − " + e.load_cases[*m.minus].name : "");
  v.fitted = m.fitted;
  v.measured = m.value;
  v.u_measured = m.u;
  v.source = m.source;
  v.licence = m.licence;
  v.history = m.history;
  v.time = m.time;
  const LatticeValues model = sequence_of(r, m, v.model);
  set_limit(model, v);
  v.springs = share_of_springs(r, m, model);
  if (v.simulated && std::isfinite(v.measured)) v.error = *v.simulated - v.measured;
  return v;
}

/// Sets u_val and the ratio, or why there is none.
void judge(const std::string& fault_of_fit, ValidatedValue& v) {
  if (!v.simulated)
    v.not_judged = "no simulated value";
  else if (!v.u_numerical)
    v.not_judged = "u_num is unknown, for want of two lattices that differ";
  else if (!fault_of_fit.empty())
    v.not_judged = fault_of_fit;
  if (!v.not_judged.empty()) return;
  if (!std::isfinite(v.measured)) {
    v.u_val = std::hypot(*v.u_numerical, *v.u_input);
    v.not_judged = "not measured yet";
    return;
  }
  v.u_val = std::hypot(*v.u_numerical, *v.u_input, v.u_measured);
  const double ratio = std::abs(*v.error) / *v.u_val;
  if (std::isfinite(ratio) && std::isfinite(*v.u_val))
    v.ratio = ratio;
  else
    v.not_judged = "E or u_val is not finite";
}

/// D, or of what is not measured yet S.
double base_of(const ValidatedValue& v) { return std::isfinite(v.measured) ? v.measured : v.simulated.value_or(0); }

/// A difference, in % of D: above 0 the simulated value is the larger one.
std::string signed_percent(const ValidatedValue& v, const Maybe& x) {
  return x && base_of(v) != 0 ? fmt::format("{:+.1f}", 100 * *x / base_of(v)) : "–";
}

std::string percent(const ValidatedValue& v, const Maybe& u) {
  return u && std::isfinite(*u) && base_of(v) != 0 ? fmt::format("{:.1f}", 100 * *u / std::abs(base_of(v))) : "–";
}

std::vector<const ValidatedValue*> outside(const CaseResult& r) {
  std::vector<const ValidatedValue*> all;
  for (const ValidatedValue& v : r.validation)
    if (v.ratio && *v.ratio > no_model_error) all.push_back(&v);
  return all;
}

/// "2 not judged: sag, turn (no simulated value)", by what keeps them from it.
std::string not_judged(const CaseResult& r) {
  std::map<std::string, std::vector<std::string>> names;
  std::size_t count = 0;
  for (const ValidatedValue& v : r.validation)
    if (!v.not_judged.empty()) names[v.not_judged].push_back(v.name), ++count;
  std::vector<std::string> groups;
  for (const auto& [why, of] : names) groups.push_back(fmt::format("{} ({})", fmt::join(of, ", "), why));
  return groups.empty() ? "" : fmt::format("{} not judged: {}.", count, fmt::join(groups, "; "));
}

/// The runs behind the values that have no result, and why.
std::string failed_runs(const CaseResult& r) {
  std::vector<std::string> runs;
  for (const VariedRun& run : r.varied)
    if (!run.message.empty())
      runs.push_back(run.input.empty()
                         ? fmt::format("'{}' ({})", run.load_case, run.message)
                         : fmt::format("'{}' with '{}' changed ({})", run.load_case, run.input, run.message));
  return runs.empty() ? "" : fmt::format("Without a result: {}.", fmt::join(runs, "; "));
}

std::string judged(const CaseResult& r) {
  const auto count = std::ranges::count_if(r.validation, [](const auto& v) { return v.ratio.has_value(); });
  if (count == 0) return "";
  const std::vector<const ValidatedValue*> off = outside(r);
  std::string out = fmt::format(
      "{} of {} predicted values lie within {:g} u_val of the measured ones, which shows no error "
      "of the model there.",
      count - static_cast<long>(off.size()), count, no_model_error);
  std::vector<std::string> lines;
  for (const ValidatedValue* v : off)
    lines.push_back(fmt::format("{} ({} % = {:.1f} u_val; springs {} %, cells {} %, inputs {} %, data {} %)", v->name,
                                signed_percent(*v, v->error), *v->ratio, signed_percent(*v, v->springs),
                                signed_percent(*v, v->resolution), percent(*v, v->u_input),
                                percent(*v, v->u_measured)));
  if (!lines.empty())
    out += fmt::format(
        " Outside: {}. What springs, cells, inputs and data do not explain is the material's law, the "
        "supports and loads as they are modelled, or an uncertainty that was judged too small.",
        fmt::join(lines, "; "));
  return out;
}

std::string sentences(const CaseResult& r) {
  std::vector<std::string> all = {judged(r), not_judged(r), failed_runs(r)};
  for (const std::string& text : r.experiment.left_out) all.push_back(fmt::format("Not compared: {}.", text));
  std::erase(all, "");
  return fmt::format("{}", fmt::join(all, " "));
}

/// The values in the order of the case, judged.
std::vector<ValidatedValue> validated(const CaseResult& r) {
  const std::vector<MeasuredValue>& measured = r.experiment.measured;
  std::vector<ValidatedValue> all;
  for (const MeasuredValue& m : measured) all.push_back(simulated_beside(r, m));
  const Fit fit = fit_of(r);
  const std::string fault = fit.value ? fault_of(fit, all[static_cast<std::size_t>(fit.value - measured.data())]) : "";
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (measured[i].fitted) continue;
    if (fault.empty()) set_inputs(r, measured[i], fit, all[i]);
    judge(fault, all[i]);
  }
  return all;
}

/// The rows of one load case with one of the inputs changed, or none.
class Rows {
 public:
  Rows(const CaseResult& result, std::size_t load_case, const std::string& input) : changed_(!input.empty()) {
    const std::string& name = result.experiment.load_cases[load_case].name;
    if (load_case == 0 && input.empty()) rows_ = &result.rows;
    for (const VariedRun& run : result.varied)
      if (run.load_case == name && run.input == input) rows_ = &run.rows;
  }

  /// With an input changed there are rows of the first model on one lattice, whose label and cells may be others.
  Maybe value(const WhereComputed& at, const std::string& measure) const {
    if (rows_)
      for (const Row& row : *rows_)
        if (row.measure == measure && (changed_ || (row.model == at.model && row.cells == at.cells))) return row.value;
    return {};
  }

 private:
  const bool changed_;
  const std::vector<Row>* rows_ = nullptr;
};

/// What the end of an arm moves by beyond the middle of the patch that it turns with, along the axis of the quantity.
Maybe of_arm(const MeasuredValue& m, const Rows& rows, const WhereComputed& at) {
  const std::string turn = "turn." + patch_of_row(m.quantity);
  Vec3 vector;
  for (int d = 0; d < 3; ++d) {
    const Maybe component = rows.value(at, turn + '.' + "xyz"[d]);
    if (!component) return {};
    vector[d] = *component * std::numbers::pi / 180;
  }
  if (vector.isZero(0)) return 0;
  const Vec3 moved = Eigen::AngleAxisd(vector.norm(), vector.normalized()) * m.arm - m.arm;
  return moved[m.quantity.back() - 'x'];
}

Maybe in_load_case(const CaseResult& r, const MeasuredValue& m, std::size_t load_case, const std::string& input,
                   const WhereComputed& at) {
  const Rows rows(r, load_case, input);
  const Maybe value = rows.value(at, m.quantity);
  if (!value || m.arm.isZero(0)) return value;
  const Maybe arm = of_arm(m, rows, at);
  return arm ? Maybe(*value + *arm) : Maybe();
}

}  // namespace

void validate(CaseResult& r) {
  r.validation = validated(r);
  for (const ValidatedValue& v : r.validation) {
    if (!v.ratio) continue;
    Row row = of_run<Row>(v);
    row.case_name = r.experiment.name;
    row.kinematics = r.experiment.kinematics == "linear" ? "linear" : "finite";
    row.measure = "measured." + v.name;
    row.unit = unit_of(row.measure);
    row.value = *v.ratio;
    r.rows.push_back(row);
  }
  if (!r.validation.empty()) r.validated = sentences(r);
}

std::string validation_table(const CaseResult& r) {
  if (r.validation.empty()) return "";
  constexpr const char* form = "{:<26} {:>11} {:>11} {:<4} {:>6} {:>6} {:>7} {:>6} {:>6} {:>7}\n";
  std::string out = fmt::format("\n{}, {} beside what was measured; E and u in % of D\n", r.experiment.name,
                                r.validation.front().model) +
                    fmt::format(form, "", "S", "D", "", "E", "u_num", "u_input", "u_D", "u_val", "E/u_val");
  for (const bool fitted : {true, false})
    for (const ValidatedValue& v : r.validation)
      if (v.fitted == fitted)
        out += fmt::format(form, v.name, v.simulated ? fmt::format("{:.5g}", *v.simulated) : "–",
                           std::isfinite(v.measured) ? fmt::format("{:.5g}", v.measured) : "awaited", v.unit,
                           signed_percent(v, v.error), percent(v, v.u_numerical), fitted ? "" : percent(v, v.u_input),
                           percent(v, v.u_measured), fitted ? "" : percent(v, v.u_val),
                           fitted    ? "fit"
                           : v.ratio ? fmt::format("{:.1f}", *v.ratio)
                                     : "–");
  return out + r.validated + "\n";
}

Maybe simulated(const CaseResult& r, const MeasuredValue& m, const std::string& input, const WhereComputed& at) {
  const Maybe value = in_load_case(r, m, m.of, input, at);
  if (!value || !m.minus) return value;
  const Maybe other = in_load_case(r, m, *m.minus, input, at);
  return other ? Maybe(*value - *other) : Maybe();
}

bool has_fewer_cells(const Cells& a, const Cells& b) { return cell_count(a) < cell_count(b); }

LatticeValues sequence_of(const CaseResult& r, const MeasuredValue& m, const std::string& model) {
  std::vector<Cells> all = r.cells;
  std::ranges::sort(all, has_fewer_cells);
  LatticeValues out;
  for (const Cells& cells : all)
    if (const Maybe value = simulated(r, m, "", {model, cells})) {
      out.cells.push_back(cells);
      out.values.push_back(*value);
    }
  return out;
}

std::optional<ReferenceValue> limit_of(const LatticeValues& s) {
  const std::size_t n = s.values.size();
  const auto ratio = [&](std::size_t fine) { return size_ratio(s.cells[fine - 1], s.cells[fine], s.cells.back()); };
  if (n < 2) return {};
  if (n > 2) return extrapolate(s.values, solver_noise * std::abs(s.values.back()), {}, {ratio(n - 2), ratio(n - 1)});
  if (ratio(1) < smallest_ratio) return {};
  const double step = (s.values[1] - s.values[0]) / (ratio(1) - 1);  // at first order
  return ReferenceValue{s.values[1] + step, coarse_safety_factor * std::abs(step), {}, ""};
}

}  // namespace springproof
