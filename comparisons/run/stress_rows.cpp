#include "comparisons/run/stress_rows.h"

#include <fmt/format.h>

#include "comparisons/prepare/sampling.h"
#include "comparisons/run/case_rows.h"
#include "problem/case_file/measures.h"

namespace springproof {
namespace {

std::string error_name(const PartRun& run, int invariant) {
  return rows_of_measure("stress_error", run.experiment())[invariant];
}

std::string place_of(const PartRun& run) {
  const Eigen::RowVector3d at = stress_points(run.prepared).row(run.stress->place);
  return fmt::format("({:.3g}, {:.3g}, {:.3g}) m", at[0], at[1], at[2]);
}

/// Of each invariant as a share of its size: in the L2 norm, what is known to be off.
Eigen::Vector3d uncertainties(const StressLimit& limit, const Eigen::VectorXd& volumes) {
  NodalVectors doubt(limit.of_points.rows(), 3);
  for (int k = 0; k < 3; ++k) doubt.col(k) = limit.fields[k].nodal_uncertainty;
  return stress_errors(doubt, limit, volumes);
}

ReferenceRecord blank_record(const PartRun& run, const std::string& measure) {
  ReferenceRecord record;
  record.poisson_ratio = run.setting();
  record.measure = measure;
  record.unit = unit_of(measure);
  record.element = run.grids.elements.front().element;
  for (const fem::Solution& s : run.grids.elements.front().grids) record.cells.push_back(s.grid.cells);
  return record;
}

void record_errors(PartRun& run, const Eigen::VectorXd& volumes) {
  std::array<Eigen::Vector3d, 3> off;
  for (int g = 0; g < 3; ++g)
    off[g] = stress_errors(run.stress->of_grids[g] - run.stress->of_points, *run.stress, volumes);
  const Eigen::Vector3d uncertainty = uncertainties(*run.stress, volumes);
  for (int k = 0; k < 3; ++k) {
    const ReferenceField& field = run.stress->fields[k];
    ReferenceRecord record = blank_record(run, error_name(run, k));
    record.values = {off[0][k], off[1][k], off[2][k]};
    record.observed_order = field.observed_order;
    record.uncertainty = uncertainty[k];
    record.note = with_note(run.grids.elements.front(), field.note);
    record.converging = field.sequence != Sequence::not_converging;
    record.correlation = field.correlation;
    run.part.references.push_back(record);
  }
}

void record_peak(PartRun& run) {
  const ReferenceValue& peak = run.stress->peak;
  ReferenceRecord record = blank_record(run, "stress_peak");
  for (const double of_grid : run.stress->peaks()) record.values.push_back(of_grid);
  record.value = peak.value;
  record.uncertainty = peak.uncertainty;
  record.observed_order = peak.observed_order;
  record.converging = peak.sequence != Sequence::not_converging;
  record.note = fmt::format("at {}; {}", place_of(run), peak.note);
  if (run.stress->peak_is_singular()) record.note += "; has no limit, as at a singular edge: not compared";
  run.part.references.push_back(record);
}

}  // namespace

ProbeStresses at_stress_points(const PartRun& run, std::size_t lattice, const ModelParameters& parameters,
                               const std::array<NodalVectors, 2>& of_nodes) {
  const Lattice& here = run.prepared.lattices[lattice];
  const NodalVectors points = stress_points(run.prepared);
  ProbeStresses out(points.rows(), 6);
  for (int k = 0; k < 2; ++k)
    out.middleCols<3>(3 * k) = parameters.cut.value_or(false)
                                   ? displacement_at(cells_of(here, parameters), of_nodes[k], points)
                                   : at_points(*here.mesh, of_nodes[k], points);
  return out;
}

ProbeStresses at_stress_points(const PartRun& run, std::size_t lattice, const fem::Solution& solution) {
  const Mesh& mesh = run.mesh(lattice);
  const NodalVectors points = stress_points(run.prepared);
  if (solution.grid.element != "q1" || solution.stress.rows() <= points.rows())
    return solution.stress.topRows(std::min(points.rows(), solution.stress.rows()));
  const ProbeStresses of_nodes =
      solution.stress.middleRows(points.rows() + run.prepared.lattices[lattice].first_node, mesh.nodes.rows());
  ProbeStresses out(points.rows(), 6);
  out << at_points(mesh, of_nodes.leftCols<3>(), points), at_points(mesh, of_nodes.rightCols<3>(), points);
  return out;
}

void build_stress_limit(PartRun& run, double doubt) {
  const std::vector<std::string>& measures = run.experiment().measures;
  if (!wanted("stress_peak", measures) && !wanted("stress_error", measures)) return;
  const Eigen::VectorXd volumes = stress_volumes(run.prepared);
  const ElementGrids& first = run.grids.elements.front();
  if (volumes.sum() == 0) return;  // not compared
  std::array<ProbeStresses, 3> grids;
  for (int g = 0; g < 3; ++g) grids[g] = first.grids[g].stress.topRows(volumes.size());
  run.stress = stress_limit(grids, volumes, ratios_of(first), doubt);
  for (ReferenceField& field : run.stress->fields) widen(run.prepared.body.load_spread, field);
  run.stress->peak.uncertainty += run.prepared.body.load_spread * run.stress->peak.value;
  if (wanted("stress_error", measures)) record_errors(run, volumes);
  if (wanted("stress_peak", measures)) record_peak(run);
}

void add_stress_errors(PartRun& run, const RunKey& key, const std::string& kinematics, const ProbeStresses& stress) {
  if (!run.stress || stress.rows() != run.stress->of_points.rows()) return;
  const StressLimit& limit = *run.stress;
  const Eigen::VectorXd volumes = stress_volumes(run.prepared);
  const NodalVectors ours = invariants(stress);
  const Eigen::Vector3d errors = stress_errors(ours - limit.of_points, limit, volumes),
                        uncertainty = uncertainties(limit, volumes);
  const auto add = [&](const std::string& measure, double value, double reference, double doubt) {
    if (!wanted(measure, run.experiment().measures)) return;
    Row row = blank_row(run, key, kinematics);
    row.measure = measure;
    row.unit = unit_of(measure);
    row.samples = 1;
    row.value = value;
    row.error = value - reference;
    row.reference = reference;
    row.reference_uncertainty = doubt;
    if (measure == "stress_peak") row.of = place_of(run);
    run.part.rows.push_back(row);
  };
  for (int k = 0; k < 3; ++k) add(error_name(run, k), errors[k], 0, uncertainty[k]);
  if (!limit.peak_is_singular()) add("stress_peak", ours.col(0).maxCoeff(), limit.peak.value, limit.peak.uncertainty);
}

}  // namespace springproof
