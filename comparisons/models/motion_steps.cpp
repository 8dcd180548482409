#include "comparisons/models/motion_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "msm/dynamics/checked_step.h"
#include "msm/dynamics/lattice_motion.h"
#include "msm/dynamics/terms/energy_momentum.h"
#include "msm/laws/capabilities.h"

namespace springproof {
namespace {

constexpr double most_steps = 1e8;
// Ratio of a wanted step to the explicit bound, above which "auto" takes it (docs/motion.md).
constexpr double worthwhile_ratio = 50, worthwhile_ratio_beside_kernels = 500;

/// The integrator of the case, of "auto" the explicit one.
Integrator integrator_of(const MotionChoice& motion, bool only_explicit) {
  if (motion.integrator == "explicit" || motion.integrator == "auto") return Integrator::explicit_euler;
  if (only_explicit)
    throw InputError(
        motion.integrator_where,
        fmt::format("dynamics.integrator: {} has a plane for nodes, not for the surface of the cut cells of "
                    "a model of the case (allowed for it: explicit, auto; or cut = false)",
                    motion.integrator));
  return motion.integrator == "implicit_euler" ? Integrator::implicit_euler : Integrator::energy_momentum;
}

/// checked_time_step(), which says where the case has the option that it refuses.
double step_of(const Experiment& experiment, const MassSpringModel& model, const IsotropicMaterial& material,
               const MotionOptions& options) {
  const MotionChoice& motion = *experiment.dynamics;
  try {
    return checked_time_step(model, material.density, options);
  } catch (const MotionOptionError& e) {
    const SourceLocation& where = e.option() == "integrator"         ? motion.integrator_where
                                  : e.option() == "mass_consistency" ? motion.mass_where
                                                                     : motion.where;
    throw InputError(where,
                     fmt::format("dynamics.{}, of a model of the case at nu = {}", e.what(), material.poisson_ratio));
  }
}

/// Of "auto" [s]: the given step, or a frame.
double wanted_step(const MotionChoice& motion) {
  return motion.time_step.value_or(motion.duration / std::max(motion.frames, 1));
}

/// Whether "auto" takes large steps.
/// @param own the model's own explicit step [s]
bool large_steps_pay(const MotionChoice& motion, const MassSpringModel& model, double own,
                     const MotionOptions& options) {
  const double ratio = LatticeMotion::suits(model, {.viscosity = options.viscosity, .relaxation = options.relaxation})
                           ? worthwhile_ratio_beside_kernels
                           : worthwhile_ratio;
  return can(model, Capability::energy_momentum) && wanted_step(motion) > ratio * (own / share_of_bound);
}

/// Branches of a model.
/// @throws InputError at [material.relaxation] if it has none.
RelaxingCells relaxing_of(const Experiment& experiment, const MassSpringModel& model,
                          const IsotropicMaterial& material) {
  if (const std::string why = experiment.relaxation.acts() ? lacks(model, Capability::relaxation) : ""; !why.empty())
    throw InputError(
        experiment.relaxation_where,
        fmt::format("material.relaxation: does not suit a model of the case in motion: {} (allowed for it: "
                    "none; with it: models of cells, as hybmss_avg)",
                    why));
  return RelaxingCells::of(model, material, experiment.relaxation);
}

}  // namespace

MotionSteps steps_of(const Experiment& experiment, const MassSpringModel& model, const IsotropicMaterial& material) {
  const MotionChoice& motion = *experiment.dynamics;
  const bool only_explicit = motion.plane && (model.network.cells.cut() || motion.plane->friction > 0),
             automatic = motion.integrator == "auto";
  MotionOptions options = {.integrator = integrator_of(motion, only_explicit),
                           .damping = motion.damping,
                           .viscosity = Viscosity::of(model, material, motion.viscosity),
                           .relaxation = relaxing_of(experiment, model, material),
                           .mass_consistency = motion.mass_consistency};
  if (!automatic) options.time_step = motion.time_step;
  double size = step_of(experiment, model, material, options);
  if (automatic && !only_explicit && large_steps_pay(motion, model, size, options)) {
    options.integrator = Integrator::energy_momentum;
    size = wanted_step(motion);
  } else if (automatic) {
    size = std::min(motion.time_step.value_or(size), size);
  } else if (options.integrator != Integrator::explicit_euler && !motion.time_step) {
    size = std::min(size, motion.duration / motion.samples);
  }
  options.time_step = size;
  const double count = std::ceil(motion.duration / size);
  if (count > most_steps)
    throw InputError(motion.where, fmt::format("dynamics.duration_s: takes {:.3g} steps of {:.3g} s (allowed: up to "
                                               "{:.0g} steps)",
                                               count, size, most_steps));
  return {options, std::max(1L, static_cast<long>(count) / motion.samples)};
}

}  // namespace springproof
