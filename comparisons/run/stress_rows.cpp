#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "comparisons/prepare/sampling.h"
#include "comparisons/run/part_run.h"
#include "meshes/locate/locate.h"
#include "meshes/voxels/cells_apart.h"
#include "problem/case_file/measures.h"

namespace springproof {
namespace {

std::string error_name(const PartRun& run, int invariant) {
  return rows_of_measure("stress_error", run.experiment())[invariant];
}

std::string place_of(const PartRun& run) {
  return text(stress_points(run.prepared).row(run.stress->place).transpose(), run.experiment().units, "m", 3);
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
  record.cells = solved_cells(run.grids.elements.front());
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

/// Of the nodes of apart() at points; where materials meet of the least.
/// @param place the cell of a point and the weights of its corners
template <class Place>
ProbeStresses at_points(const NodalVectors& points, const NodalStresses& of_nodes, const CellsApart& cells,
                        const Place& place) {
  ProbeStresses out = ProbeStresses::Zero(points.rows(), 6);
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const auto [cell, weights] = place(points.row(i).transpose());
    const Hexahedron& corners = cells.corners[static_cast<std::size_t>(cell)];
    bool meet = true;  // all nodes that count are there for a lesser material too
    for (int n = 0; n < 8; ++n) meet &= std::abs(weights[n]) < 1e-9 || cells.node[corners[n]] != corners[n];
    for (int n = 0; n < 8; ++n) out.row(i) += weights[n] * of_nodes.row(meet ? cells.node[corners[n]] : corners[n]);
  }
  return out;
}

}  // namespace

ProbeStresses at_stress_points(const PartRun& run, std::size_t lattice, const ModelParameters& parameters,
                               const NodalStresses& of_nodes) {
  const Lattice& here = run.prepared.lattices[lattice];
  const Mesh& mesh = *here.mesh;
  const NodalVectors points = stress_points(run.prepared);
  if (!parameters.cut.value_or(false))
    return at_points(points, of_nodes, apart(mesh.hexahedra, mesh.materials), Locator(mesh));
  const CutBody& body = cells_of(here, parameters);
  return at_points(points, of_nodes, apart(body), [&](const Vec3& point) { return body.place(point); });
}

ProbeStresses at_stress_points(const PartRun& run, std::size_t lattice, const fem::Solution& solution) {
  const Mesh& mesh = run.mesh(lattice);
  const NodalVectors points = stress_points(run.prepared);
  const bool is_peer = solution.grid.cells == run.prepared.lattices[lattice].cells;
  if (solution.grid.element != "q1" || !is_peer || solution.stress.rows() <= points.rows())
    return solution.stress.topRows(std::min(points.rows(), solution.stress.rows()));
  Eigen::Index row = points.rows();  // of the middle of its cells
  for (std::size_t i = 0; i < lattice; ++i) row += static_cast<Eigen::Index>(run.mesh(i).hexahedra.size());
  const CellsApart cells = apart(mesh.hexahedra, mesh.materials);
  NodalStresses sum = NodalStresses::Zero(static_cast<Eigen::Index>(cells.node.size()), 6);
  Eigen::VectorXd count = Eigen::VectorXd::Zero(sum.rows());
  for (const Hexahedron& cell : cells.corners) {
    for (const int n : cell) sum.row(n) += solution.stress.row(row);
    count(cell).array() += 1;
    ++row;
  }
  return at_points(points, sum.array().colwise() / count.array(), cells, Locator(mesh));
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
    Row row = blank_row(run, key, kinematics);
    row.value = value;
    row.error = value - reference;
    row.reference = reference;
    row.reference_uncertainty = doubt;
    if (measure == "stress_peak") row.of = place_of(run);
    add_row(run, row, measure);
  };
  for (int k = 0; k < 3; ++k) add(error_name(run, k), errors[k], 0, uncertainty[k]);
  if (!limit.peak_is_singular()) add("stress_peak", ours.col(0).maxCoeff(), limit.peak.value, limit.peak.uncertainty);
}

}  // namespace springproof
