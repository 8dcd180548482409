#include "comparisons/parallel/parted_run.h"

#include <fmt/format.h>

#include "comparisons/models/model_run.h"
#include "comparisons/run/prepare.h"
#include "msm/parallel/parted_problem.h"

namespace springproof {
namespace {

/// Every process builds the same model.
struct WholeModel {
  PreparedCase prepared;
  EmbeddedModel built;
  BoundaryConditions conditions;
};

WholeModel build_whole(const ParallelCase& c) {
  WholeModel whole{prepare_lattices(c.experiment), {}, {}};
  const PreparedCase& prepared = whole.prepared;
  const ModelParameters& parameters = prepared.models.front();
  const Lattice& lattice = prepared.lattices.front();
  whole.built = build_on(prepared, lattice, parameters, c.material, false);
  if (!conservative(whole.built.model))
    throw InputError(
        fmt::format("{}: model \"{}\": its forces have no energy, so its stiffness is not symmetric "
                    "(allowed: models with an energy)",
                    c.experiment.file.string(), parameters.row.name));
  whole.conditions = conditions_of(prepared, lattice, parameters, whole.built, c.material.density);
  require_supported(whole.conditions, whole.built.model.network.X);
  return whole;
}

}  // namespace

nlohmann::json solve_in_parts(const ParallelCase& c, double tolerance, int max_iterations, MPI_Comm communicator) {
  const int rank = rank_of(communicator);
  const Sum sum{communicator};
  const double start = wall_seconds();
  WholeModel whole;
  agree(communicator, [&] { whole = build_whole(c); });
  PartedProblem problem(whole.built.model, whole.conditions, communicator);
  if (rank > 0) whole = {};  // the first process alone measures
  const double set_up = wall_seconds() - start;
  SolvedModel solved;
  solved.state = problem.solve(tolerance, max_iterations);
  const Equilibrium& state = solved.state;
  nlohmann::json result = {
      {"converged", state.ok},
      {"unknowns", state.unknowns},
      {"solver", state.solver},
      {"iterations", state.iterations},
      {"residual", state.residual},
      {"set_up_seconds", sum.largest(set_up)},
      {"solve_seconds", sum.largest(wall_seconds() - start - set_up)},
      {"MiB_per_process", sum.largest(peak_memory_MiB())},
      {"displacement_rms_m", state.displacement.norm() / std::sqrt(static_cast<double>(state.displacement.size()))},
      {"measures", nlohmann::json::object()}};
  if (rank > 0 || !state.ok) return result;
  solved.built = std::move(whole.built);
  solved.conditions = std::move(whole.conditions);
  result["measures"] =
      measured(whole.prepared, whole.prepared.lattices.front(), whole.prepared.models.front(), std::move(solved), false)
          .scalars;
  return result;
}

}  // namespace springproof
