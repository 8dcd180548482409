#include "msm/dynamics/checked_step.h"

#include <fmt/format.h>

#include "msm/dynamics/terms/mass_average.h"
#include "msm/dynamics/terms/plane_contact.h"
#include "msm/dynamics/time_step.h"
#include "msm/laws/capabilities.h"

namespace springproof {
namespace {

constexpr double implicit_ratio = 10;  // default step of implicit methods to the explicit bound

void check_mass(const MassSpringModel& model, const MotionOptions& options) {
  const auto refuse = [](const std::string& reason) { throw MotionOptionError("mass_consistency", reason); };
  const double theta = options.mass_consistency;
  if (!(theta >= 0 && theta <= 1)) refuse(fmt::format("{:g} is no share of consistent mass (allowed: 0 to 1)", theta));
  if (theta == 0) return;
  if (options.integrator != Integrator::explicit_euler)
    refuse("large steps have lumped mass (allowed beside it: integrator = \"explicit\")");
  if (options.contact) refuse("impulses of a plane need lumped mass (allowed beside it: no plane)");
  if (options.lagged) refuse("lagged dispersion needs lumped mass");
  if (const std::string why = lacks(model, Capability::mass_average); !why.empty())
    refuse(fmt::format("does not suit this model: {} (allowed for it: 0)", why));
}

void check_integrator(const MassSpringModel& model, const MotionOptions& options) {
  const auto refuse = [](const std::string& reason) { throw MotionOptionError("integrator", reason); };
  if (options.integrator == Integrator::explicit_euler) return;
  const std::string why =
      options.integrator == Integrator::energy_momentum ? lacks(model, Capability::energy_momentum) : "";
  if (!why.empty())
    refuse(fmt::format("energy_momentum does not suit this model: {} (allowed for it: explicit, implicit_euler)", why));
  if (options.lagged) refuse("lagged dispersion needs the explicit one");
  if (!options.contact) return;
  if (options.contact->plane().friction > 0)
    refuse("large steps have a plane without friction (allowed: friction = 0, or explicit)");
  if (!options.contact->of_nodes() || !model.network.cells.carried.empty())
    refuse(
        "large steps have contact of nodes, not of the surface of cut cells (allowed: cut = false, or "
        "explicit)");
}

void check_damping(const MassSpringModel& model, double density, double dt, const MotionOptions& options) {
  if (const std::string why = options.viscosity.acts() ? lacks(model, Capability::viscosity) : ""; !why.empty())
    throw MotionOptionError("viscosity", "does not suit this model: " + why);
  if (!(options.damping >= 0)) throw MotionOptionError("damping_1_s", "must be >= 0");
  if (!options.lagged) return;
  const MomentumDispersion* dispersion = dispersion_of(model);
  if (dispersion && dispersion->form == Dispersion::finite_strain)
    throw MotionOptionError("lagged", "dispersion is not of finite strain (allowed: dispersion = \"symmetric\")");
  const double least = lagged_damping(model, density, dt);
  if (least > 0 && !(options.damping > least))
    throw MotionOptionError(
        "damping_1_s",
        fmt::format("{:.6g} 1/s lets lagged dispersion grow (allowed: > {:.6g} 1/s at a step of {:.6g} s)",
                    options.damping, least, dt));
}

}  // namespace

double checked_time_step(const MassSpringModel& model, double density, const MotionOptions& options) {
  check_mass(model, options);
  check_integrator(model, options);
  if (const std::string why = options.relaxation.acts() ? lacks(model, Capability::relaxation) : ""; !why.empty())
    throw MotionOptionError("relaxation", "does not suit this model: " + why);
  const double safe = relaxing_time_step(model, density, options.relaxation,
                                         safe_time_step(model, density, options.lagged, options.mass_consistency),
                                         options.mass_consistency),
               bound = viscous_time_step(model, density, options.viscosity, safe, options.mass_consistency);
  const bool implicit = options.integrator != Integrator::explicit_euler;
  const double dt = options.time_step.value_or(implicit ? implicit_ratio * safe : share_of_bound * bound);
  if (!(dt > 0) || (dt > bound && !implicit))
    throw MotionOptionError(
        "time_step_s", fmt::format("{:.6g} s is not safe for this model (allowed: up to {:.6g} s, the bound of its "
                                   "springs and cells, and above 0; or no time_step_s: each model then has its own; or "
                                   "integrator = \"energy_momentum\")",
                                   dt, bound));
  check_damping(model, density, dt, options);
  return dt;
}

double lagged_damping(const MassSpringModel& model, double density, double time_step) {
  return time_step * dispersion_frequency_squared(model, density);
}

}  // namespace springproof
