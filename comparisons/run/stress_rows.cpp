#include "comparisons/run/stress_rows.h"

#include <fmt/format.h>

#include "comparisons/judge/stress_error.h"
#include "comparisons/prepare/sampling.h"
#include "comparisons/run/case_rows.h"
#include "problem/case_file/measures.h"

namespace springproof {
namespace {

NodalVectors compared_points(const PartRun& run) {
  const NodalVectors all = stress_points(run.prepared);
  return all.bottomRows(all.rows() - first_compared_stress(run.prepared));
}

}  // namespace

ProbeStresses stresses_of(const PartRun& run, std::size_t lattice, const ModelParameters& parameters,
                          const std::array<NodalVectors, 2>& at_nodes) {
  const Lattice& here = run.prepared.lattices[lattice];
  const NodalVectors points = compared_points(run);
  ProbeStresses out(points.rows(), 6);
  for (int k = 0; k < 2; ++k)
    out.middleCols<3>(3 * k) = parameters.cut.value_or(false)
                                   ? displacement_at(cells_of(here, parameters), at_nodes[k], points)
                                   : at_points(*here.mesh, at_nodes[k], points);
  return out;
}

ProbeStresses stresses_of(const PartRun& run, const ProbeStresses& solution) {
  const Eigen::Index first = first_compared_stress(run.prepared),
                     compared = compared_stress_volumes(run.prepared).size();
  return solution.rows() == first + compared ? ProbeStresses(solution.bottomRows(compared)) : ProbeStresses(0, 6);
}

void add_stress_errors(PartRun& run, const RunKey& key, const std::string& kinematics, const ProbeStresses& stress) {
  const Eigen::VectorXd volumes = compared_stress_volumes(run.prepared);
  if (stress.rows() == 0 || run.grids.elements.empty() || !complete(run.grids.elements.front())) return;
  std::vector<ProbeStresses> grids;
  for (const fem::Solution& s : run.grids.elements.front().grids) grids.push_back(stresses_of(run, s.stress));
  const ProbeStresses& truth = grids[2];
  if (truth.rows() != stress.rows()) return;
  const StressDifference of = stress_difference(stress, truth, volumes),
                         step = stress_difference(grids[1], truth, volumes);
  const auto add = [&](const char* what, double error, double uncertainty) -> Row& {
    Row row = blank_row(run, key, kinematics);
    row.measure = fmt::format("stress_error.{}", what);
    row.unit = unit_of(row.measure);
    row.samples = 1;
    row.value = error;
    row.error = error;
    row.reference = 0.0;
    row.reference_uncertainty = std::abs(uncertainty);
    return run.part.rows.emplace_back(row);
  };
  add("von_mises", of.von_mises, step.von_mises);
  add("hydrostatic", of.hydrostatic, step.hydrostatic);
  if (!peaks_converge(peak_stress(grids[0]), peak_stress(grids[1]), peak_stress(truth))) return;
  const Eigen::RowVector3d at = compared_points(run).row(of.place);
  add("peak", of.peak, step.peak).of = fmt::format("({:.3g}, {:.3g}, {:.3g}) m", at[0], at[1], at[2]);
}

}  // namespace springproof
