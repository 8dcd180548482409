#include "comparisons/models/model_run.h"

#include <fmt/format.h>

#include <algorithm>

#include "comparisons/judge/deformation.h"
#include "comparisons/judge/line_measure.h"
#include "comparisons/judge/measures.h"
#include "comparisons/models/external.h"
#include "comparisons/models/frequencies.h"
#include "comparisons/models/region_means.h"
#include "comparisons/prepare/load_resultants.h"
#include "comparisons/prepare/sampling.h"
#include "comparisons/reference/reference_grids.h"
#include "msm/laws/capabilities.h"
#include "msm/measure/local_fields.h"
#include "msm/measure/statistics.h"
#include "msm/models.h"
#include "msm/parameters/calibrate.h"
#include "problem/case_file/measures.h"
#include "problem/system/progress.h"
#include "problem/system/run_cost.h"

namespace springproof {
namespace {

/// Whether the case measures stresses, and this model has them.
bool recovers_stress(const Experiment& e, const MassSpringModel& model) {
  return (e.asks_for("stress") || e.asks_for("stress_error") || e.asks_for("stress_peak")) &&
         can(model, Capability::recovered_stress) && e.model_kinematics() == Kinematics::linear;
}

/// The papers' moduli of a block stretched along x; lengths of the local fields follow from the network's spacing.
void add_moduli(const PreparedCase& prepared, const MassSpringModel& model, const NodalVectors& u,
                std::map<std::string, double>& out) {
  const StretchedBlock block{Vec3::Zero(), prepared.body.size, *elongation_along_x(prepared.experiment)};
  const double spacing = std::cbrt(model.network.volume.sum() / model.network.nodes());
  const double width = std::min(prepared.body.size[1], prepared.body.size[2]);
  const BlockModuli m = measure_block(model, u, block, std::min(2.5 * spacing, 0.45 * width));
  out["moduli.youngs_modulus"] = m.youngs_modulus_nominal;
  out["moduli.youngs_modulus_local"] = m.youngs_modulus_local;
  out["moduli.poisson_ratio"] = m.poisson_ratio;
  out["moduli.poisson_ratio_of_fields"] = m.poisson_ratio_of_fields;
  out["moduli.poisson_ratio_as_printed"] = m.poisson_ratio_as_printed;
  out["moduli.affine_youngs_modulus"] = 2.5 * affine_shear_modulus(model.network);
}

SolvedModel solve_network(const PreparedCase& prepared, const Lattice& lattice, const ModelParameters& parameters,
                          const IsotropicMaterial& material, bool in_motion) {
  const Experiment& e = prepared.experiment;
  const Kinematics kinematics = e.model_kinematics();
  const double start = cpu_seconds();
  SolvedModel s{build_on(prepared, lattice, parameters, material, in_motion), {}, {}, {}, {}};
  const LoadPath path = [&](double factor) {
    return conditions_of(prepared, lattice, parameters, s.built, material.density, factor);
  };
  s.conditions = path(1.0);
  const double ready = cpu_seconds();
  LinearOptions options;
  if (e.cost) options.tolerance = compared_residual;
  s.state = in_motion                          ? run_motion({prepared, lattice, s.built, material}, path, s.motion)
            : kinematics == Kinematics::linear ? solve_linear(s.built.model, s.conditions, options)
                                               : solve_finite(s.built.model, path, {.softest_motion = !e.cost});
  s.times = {ready - start, cpu_seconds() - ready};
  return s;
}

/// Solves with times that can be compared, and the memory of this run alone.
SolvedModel solve_and_count(const PreparedCase& prepared, const Lattice& lattice, const ModelParameters& parameters,
                            const IsotropicMaterial& material, bool in_motion) {
  const auto solve = [&] { return solve_network(prepared, lattice, parameters, material, in_motion); };
  if (&lattice == &prepared.lattices.front()) solve();  // memory retained between runs is not counted
  const MemoryGrowth memory;
  SolvedModel s = solve();
  s.state.memory_MiB = memory.most_MiB();
  if (s.state.ok) s.times = least_times(s.times, [&] { return solve().times; });
  return s;
}

constexpr const char* names_of_losses[] = {"", "unstable", "inverted cell", "no convergence"};  // in the order of Loss

/// Of a lattice whose nodes are the mesh's.  A motion has the wrinkles of its worst frame over the strain of its
/// largest: what rings when little is strained is no wrinkle.
Stability stability_of(const Equilibrium& state, const Mesh& mesh, const MotionRecord& motion, Kinematics kinematics) {
  Wrinkles worst = wrinkles(mesh, state.displacement);
  for (const auto& [time, displacement] : motion.frames) {
    const Wrinkles frame = wrinkles(mesh, displacement);
    worst = {std::max(worst.alternating, frame.alternating), std::max(worst.strain, frame.strain)};
  }
  Stability s{state.load_reached, names_of_losses[static_cast<int>(state.loss)], 0, {}, {}, worst.share()};
  s.strain = deformation_size(mesh, state.displacement, kinematics).principal_strain;
  if (!state.softest) return s;
  s.softest = state.softest->stiffness;
  s.alternation.assign(state.softest->alternation.begin(), state.softest->alternation.end());
  return s;
}

/// Forces of gravity on the nodes [N] at a fraction of the loads.
NodalVectors weight_of_body(const PreparedCase& prepared, const Lattice& lattice, const EmbeddedModel& built,
                            double factor) {
  const Experiment& e = prepared.experiment;
  std::vector<Load> gravity = prepared.loads;
  std::erase_if(gravity, [](const Load& load) { return !std::holds_alternative<Gravity>(load); });
  return transfer(gravity, *lattice.mesh, built.embedding, built.model.network, e.materials.front().density,
                  e.model_kinematics(), factor)
      .external;
}

/// One network of a model, solved and measured.
ModelSample run_sample(const PreparedCase& prepared, const Lattice& lattice, std::size_t number,
                       const ModelParameters& parameters, const IsotropicMaterial& material) {
  const bool in_motion = prepared.experiment.models[number].in_motion;
  const auto solve = prepared.experiment.cost ? solve_and_count : solve_network;
  const IsotropicMaterial solid = in_motion ? material : prepared.experiment.at_rest(material);
  ModelSample sample =
      measured(prepared, lattice, parameters, solve(prepared, lattice, parameters, solid, in_motion), in_motion);
  if (prepared.experiment.asks_for("frequency") && sample.state.ok && !in_motion)
    sample.scalars.merge(lowest_frequencies(prepared, lattice, number, material));
  return sample;
}

}  // namespace

BoundaryConditions conditions_of(const PreparedCase& prepared, const Lattice& lattice,
                                 const ModelParameters& parameters, const EmbeddedModel& built, double density,
                                 double factor) {
  const Network& network = built.model.network;
  BoundaryConditions bc = transfer(prepared.loads, *lattice.mesh, built.embedding, network, density,
                                   prepared.experiment.model_kinematics(), factor);
  if (parameters.hold_rigid_motions) hold_free_motions(network.X, bc, network.cells.carried);
  return bc;
}

ModelSample measured(const PreparedCase& prepared, const Lattice& lattice, const ModelParameters& parameters,
                     SolvedModel solved, bool in_motion) {
  const Experiment& e = prepared.experiment;
  const auto& mesh = lattice.mesh;
  auto& [built, conditions, state, times, motion] = solved;
  const Network& network = built.model.network;
  ModelSample sample;
  sample.state = state;
  sample.times = times;
  sample.motion = std::move(motion);
  if (sample.state.displacement.rows() == mesh->nodes.rows() && !network.cells.empty() && !network.cells.cut())
    sample.stability = stability_of(sample.state, *mesh, sample.motion, e.model_kinematics());
  if (!sample.state.ok) return sample;
  sample.field =
      to_field(sample.state, mesh, built.embedding, network, prepared.loads, conditions, e.model_kinematics());
  if (e.body.is_voxels()) sample.field.reactions = about_true_patches(prepared, *mesh, sample.field.reactions);
  if (network.cells.cut()) {  // of its own field
    const VolumeChange change = volume_change(network, sample.state.displacement);
    sample.field.volume_change = change.exact;
    sample.field.volume_change_first_order = change.first_order;
  }
  const bool cut = parameters.cut.value_or(false);
  sample.scalars = field_measures(
      prepared, sample.field,
      cut ? displacement_at(cells_of(lattice, parameters), sample.state.displacement, measured_points(prepared))
          : at_measured_points(prepared, lattice, sample.field.displacement));
  if (cut && averaged_springs_of(built.model) && e.asks_for("promised_error") && !in_motion)
    sample.scalars["promised_error"] =
        lattice.falls_short * cell_energies(built.model, sample.state.displacement).estimated_error();
  if (recovers_stress(e, built.model) && !in_motion && (cut || network.cells.corners == mesh->hexahedra))
    sample.stress = recovered_stress(built.model, sample.state.displacement);
  const bool by_material = !network.cells.materials.empty();
  if (by_material && e.asks_for("region"))
    sample.scalars.merge(region_means(built.model, e.regions, sample.state.displacement, e.model_kinematics()));
  if (by_material && e.asks_for("interface"))
    sample.scalars.merge(interface_forces(
        built.model, e.regions, sample.state.displacement,
        weight_of_body(prepared, lattice, built, in_motion ? 0 : sample.state.load_reached), e.model_kinematics()));
  if (e.asks_for("network")) add_network(network, sample.scalars);
  if (e.asks_for("line")) {
    sample.line = sample_line(*e.line, *kelvin_of(e), built.model, sample.state.displacement);
    sample.scalars.merge(line_deviations(*sample.line));
  }
  if (e.asks_for("moduli")) add_moduli(prepared, built.model, sample.state.displacement, sample.scalars);
  return sample;
}

void add_network(const Network& network, std::map<std::string, double>& out) {
  const NetworkStatistics s = statistics(network);
  out["network.nodes"] = static_cast<double>(s.nodes);
  out["network.springs"] = static_cast<double>(s.springs);
  out["network.springs_per_node"] = s.springs_per_node;
  out["network.mean_length"] = s.mean_length;
  out["network.length_deviation"] = s.length_deviation;
}

std::vector<ModelSample> run_samples(const PreparedCase& prepared, const Lattice& lattice, ChosenModel model,
                                     const IsotropicMaterial& material) {
  const auto [number, whole_cubes] = model;
  if (is_external(prepared.experiment.models[number])) return external_samples(prepared, lattice, number, material);
  std::vector<ModelSample> samples;
  ModelParameters parameters = prepared.models[number];
  if (whole_cubes) parameters.cut = false;
  for (int seed = 0; seed < prepared.models[number].seeds; ++seed, ++parameters.random.seed) {
    progress::phase(
        fmt::format("{} on {} cells{}", prepared.experiment.models[number].label, cells_text(lattice.cells, " x "),
                    parameters.seeds > 1 ? fmt::format(", network {} of {}", seed + 1, parameters.seeds) : ""));
    try {
      samples.push_back(run_sample(prepared, lattice, number, parameters, material));
    } catch (const InputError&) {
      throw;
    } catch (const std::runtime_error& e) {  // the network cannot have this material's moduli
      samples.emplace_back();
      samples.back().state.message = e.what();
    } catch (const std::invalid_argument& e) {  // node placement jams with this seed
      samples.emplace_back();
      samples.back().state.message = e.what();
    }
  }
  return samples;
}

}  // namespace springproof
