#include <vector>

#include "comparisons/results/records.h"

namespace springproof {
namespace {

void divide(double& x, double by) { x /= by; }
void divide(std::optional<double>& x, double by) {
  if (x) *x /= by;
}
void divide(std::vector<double>& all, double by) {
  for (double& x : all) x /= by;
}

/// Numbers of one record, whose unit is theirs in SI until they are given in that of the case.
template <class... Numbers>
void give(Units units, std::string& unit, Numbers&... numbers) {
  const Named in = unit_in(units, unit);
  unit = in.name;
  if (in.in_si != 1) (divide(numbers, in.in_si), ...);
}

}  // namespace

void give_in_units_of_case(CaseResult& result) {
  const Units units = result.experiment.units;
  for (Row& r : result.rows) give(units, r.unit, r.value, r.reference, r.reference_uncertainty, r.error, r.spread);
  for (ReferenceRecord& r : result.references) give(units, r.unit, r.values, r.value, r.uncertainty);
  for (Check& c : result.checks) give(units, c.unit, c.expected, c.computed, c.within, c.reference_uncertainty);
  for (PublishedRow& p : result.published) give(units, p.unit, p.published, p.computed);
  for (ValidatedValue& v : result.validation) {
    for (InputShare& share : v.inputs) {
      std::string unit = v.unit;
      give(units, unit, share.change);
    }
    give(units, v.unit, v.measured, v.u_measured, v.simulated, v.u_numerical, v.u_input, v.error, v.u_val, v.springs,
         v.resolution);
  }
  for (ErrorSplit& s : result.splits)
    give(units, s.unit, s.total, s.model_error, s.discretisation_error, s.geometry_error, s.uncertainty,
         s.voxel_uncertainty, s.facets);
  for (HistoryRecord& h : result.histories)
    for (std::size_t i = 0; i < h.units.size(); ++i) give(units, h.units[i], h.values[i]);
}

}  // namespace springproof
