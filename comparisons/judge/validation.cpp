#include "comparisons/judge/validation.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "comparisons/judge/reference_value.h"
#include "problem/case_file/measures.h"

namespace springproof {
namespace {

using Maybe = std::optional<double>;

/// The rows of one load case with one of the inputs changed, or none.
class Rows {
 public:
  Rows(const CaseResult& result, std::size_t load_case, const std::string& input) {
    const std::string& name = result.experiment.load_cases[load_case].name;
    if (load_case == 0 && input.empty()) rows_ = &result.rows;
    for (const VariedRun& run : result.varied)
      if (run.load_case == name && run.input == input) rows_ = &run.rows;
  }

  Maybe value(const std::string& model, const Cells& cells, const std::string& measure) const {
    if (rows_)
      for (const Row& row : *rows_)
        if (row.model == model && row.cells == cells && row.measure == measure) return row.value;
    return {};
  }

 private:
  const std::vector<Row>* rows_ = nullptr;
};

/// Where a computation was made.
struct Where {
  std::string model;
  Cells cells;
};

/// What the end of an arm moves by beyond the middle of the patch that it turns with, along the axis of the quantity.
Maybe of_arm(const MeasuredValue& m, const Rows& rows, const Where& at) {
  const std::string turn = "turn." + patch_of_row(m.quantity);
  Vec3 vector;
  for (int d = 0; d < 3; ++d) {
    const Maybe component = rows.value(at.model, at.cells, turn + '.' + "xyz"[d]);
    if (!component) return {};
    vector[d] = *component * std::numbers::pi / 180;
  }
  if (vector.isZero(0)) return 0;
  const Vec3 moved = Eigen::AngleAxisd(vector.norm(), vector.normalized()) * m.arm - m.arm;
  return moved[m.quantity.back() - 'x'];
}

Maybe in_load_case(const CaseResult& r, const MeasuredValue& m, std::size_t load_case, const std::string& input,
                   const Where& at) {
  const Rows rows(r, load_case, input);
  const Maybe value = rows.value(at.model, at.cells, m.quantity);
  if (!value || m.arm.isZero(0)) return value;
  const Maybe arm = of_arm(m, rows, at);
  return arm ? Maybe(*value + *arm) : Maybe();
}

/// The quantity as it was measured, with one of the inputs changed, or none.
Maybe simulated(const CaseResult& r, const MeasuredValue& m, const std::string& input, const Where& at) {
  const Maybe value = in_load_case(r, m, m.of, input, at);
  if (!value || !m.minus) return value;
  const Maybe other = in_load_case(r, m, *m.minus, input, at);
  return other ? Maybe(*value - *other) : Maybe();
}

/// Values on the lattices that have one, coarse to fine.
struct Sequence {
  std::vector<Cells> cells;
  std::vector<double> values;
};

Sequence sequence_of(const CaseResult& r, const MeasuredValue& m, const std::string& model) {
  std::vector<Cells> all = r.cells;
  std::sort(all.begin(), all.end(), [](const Cells& a, const Cells& b) { return cell_count(a) < cell_count(b); });
  Sequence out;
  for (const Cells& cells : all)
    if (const Maybe value = simulated(r, m, "", {model, cells})) {
      out.cells.push_back(cells);
      out.values.push_back(*value);
    }
  return out;
}

double ratio(const Cells& coarse, const Cells& fine) { return std::cbrt(cell_count(fine) / cell_count(coarse)); }

/// Sets S and u_num: half of the uncertainty of a limit, which is about two standard ones.
void set_limit(const Sequence& s, ValidatedValue& v) {
  const std::size_t n = s.values.size();
  if (n == 0) return;
  v.simulated = s.values.back();
  if (n == 1) return;
  const ReferenceValue limit =
      n == 2 ? extrapolate_two(s.values[0], s.values[1])
             : extrapolate(s.values, solver_noise * std::abs(s.values.back()), clamped_order,
                           {ratio(s.cells[n - 3], s.cells[n - 2]), ratio(s.cells[n - 2], s.cells[n - 1])});
  v.simulated = limit.value;
  v.u_numerical = limit.uncertainty / 2;
  v.resolution = s.values.back() - limit.value;
}

/// Relative change of a simulated value by an input, on the coarsest lattice; 0 where the load case does not have it.
double change_by(const CaseResult& r, const MeasuredValue& m, const std::string& input) {
  const Where at{r.experiment.models.front().label,
                 r.experiment.body.is_voxels() ? r.cells.front() : r.experiment.body.cells.front()};
  const Maybe before = simulated(r, m, "", at), after = simulated(r, m, input, at);
  return before && after && *before != 0 ? *after / *before - 1 : 0;
}

const MeasuredValue* fitted_value(const Experiment& e) {
  const auto found = std::find_if(e.measured.begin(), e.measured.end(), [](const auto& m) { return m.fitted; });
  return found == e.measured.end() ? nullptr : &*found;
}

/// The shares of the inputs in a value.  A fit to another value f answers to a change of an input there: what is left
/// here is J - (dS/dp) / (dS_f/dp) J_f; of f itself nothing.
void set_inputs(const CaseResult& r, const MeasuredValue& m, ValidatedValue& v) {
  const Experiment& e = r.experiment;
  const MeasuredValue* fit = fitted_value(e);
  double answer = 0;  // relative change here per relative change of f
  for (const UncertainInput& input : e.inputs)
    if (input.kind == UncertainInput::Kind::fitted)
      answer = change_by(r, m, input.name) / change_by(r, *fit, input.name);
  const double S = v.simulated.value_or(0);
  double squares = 0;
  const auto add = [&](const std::string& name, double change, bool alternative) {
    v.inputs.push_back({name, change * S, alternative});
    if (!alternative) squares += std::pow(change * S, 2);
  };
  for (const UncertainInput& input : e.inputs) {
    if (input.kind == UncertainInput::Kind::fitted || m.fitted) continue;
    const double there = fit ? change_by(r, *fit, input.name) : 0;
    add(input.name, change_by(r, m, input.name) - answer * there, input.kind == UncertainInput::Kind::alternative);
  }
  if (fit && !m.fitted) add("fit to " + fit->name, answer * fit->u / std::abs(fit->value), false);
  v.u_input = std::sqrt(squares);
}

/// On the finest cells where both are known.
Maybe share_of_springs(const CaseResult& r, const MeasuredValue& m, const Sequence& model) {
  if (r.experiment.elements.empty()) return {};
  for (std::size_t i = model.cells.size(); i-- > 0;)
    if (const Maybe fem = simulated(r, m, "", {"fem_" + r.experiment.elements.front(), model.cells[i]}))
      return model.values[i] - *fem;
  return {};
}

ValidatedValue validated(const CaseResult& r, const MeasuredValue& m) {
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
  const Sequence model = sequence_of(r, m, v.model);
  set_limit(model, v);
  set_inputs(r, m, v);
  v.springs = share_of_springs(r, m, model);
  if (!v.simulated) return v;
  v.error = *v.simulated - v.measured;
  if (!v.u_numerical || v.fitted) return v;
  v.u_val = std::hypot(*v.u_numerical, v.u_input, v.u_measured);
  v.ratio = std::abs(*v.error) / *v.u_val;
  return v;
}

/// A difference, in % of D: above 0 the simulated value is the larger one.
std::string signed_percent(const ValidatedValue& v, const Maybe& x) {
  return x ? fmt::format("{:+.1f}", 100 * *x / v.measured) : "–";
}

std::string percent(const ValidatedValue& v, const Maybe& u) {
  return u ? fmt::format("{:.1f}", 100 * *u / std::abs(v.measured)) : "–";
}

std::vector<const ValidatedValue*> outside(const CaseResult& r) {
  std::vector<const ValidatedValue*> all;
  for (const ValidatedValue& v : r.validation)
    if (v.ratio && *v.ratio > no_model_error) all.push_back(&v);
  return all;
}

std::string sentences(const CaseResult& r) {
  const auto judged =
      std::count_if(r.validation.begin(), r.validation.end(), [](const auto& v) { return v.ratio.has_value(); });
  const std::vector<const ValidatedValue*> off = outside(r);
  std::string out = fmt::format(
      "{} of {} predicted values lie within {:g} u_val of the measured ones, which shows no error "
      "of the model there.",
      judged - static_cast<long>(off.size()), judged, no_model_error);
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
  for (const std::string& text : r.experiment.left_out) out += fmt::format(" Not compared: {}.", text);
  return out;
}

}  // namespace

void validate(CaseResult& r) {
  for (const MeasuredValue& m : r.experiment.measured) {
    const ValidatedValue& v = r.validation.emplace_back(validated(r, m));
    if (!v.ratio) continue;
    Row row = of_run<Row>(v);
    row.case_name = r.experiment.name;
    row.kinematics = r.experiment.kinematics == "linear" ? "linear" : "finite";
    row.measure = "measured." + m.name;
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
                           fmt::format("{:.5g}", v.measured), v.unit, signed_percent(v, v.error),
                           percent(v, v.u_numerical), fitted ? "" : percent(v, v.u_input), percent(v, v.u_measured),
                           fitted ? "" : percent(v, v.u_val),
                           fitted    ? "fit"
                           : v.ratio ? fmt::format("{:.1f}", *v.ratio)
                                     : "–");
  return out + r.validated + "\n";
}

}  // namespace springproof
