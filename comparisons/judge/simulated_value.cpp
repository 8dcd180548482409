#include "comparisons/judge/simulated_value.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "problem/case_file/measures.h"

namespace springproof {
namespace {

using Maybe = std::optional<double>;

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

Maybe simulated(const CaseResult& r, const MeasuredValue& m, const std::string& input, const WhereComputed& at) {
  const Maybe value = in_load_case(r, m, m.of, input, at);
  if (!value || !m.minus) return value;
  const Maybe other = in_load_case(r, m, *m.minus, input, at);
  return other ? Maybe(*value - *other) : Maybe();
}

bool has_fewer_cells(const Cells& a, const Cells& b) { return cell_count(a) < cell_count(b); }

LatticeValues sequence_of(const CaseResult& r, const MeasuredValue& m, const std::string& model) {
  std::vector<Cells> all = r.cells;
  std::sort(all.begin(), all.end(), has_fewer_cells);
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
