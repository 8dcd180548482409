// The [dynamics] table.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "problem/case_file/experiment_parts.h"

namespace springproof {
namespace {

/// A plane that the body falls on: of models alone, in large steps without friction.
void read_plane(const TomlTable& table, const Experiment& experiment, MotionChoice& motion) {
  const auto value = table.find("plane");
  if (!value) return;
  if (experiment.reference.in_time) refuse(*value, "has no finite elements in time", "no in_time in [reference]");
  const TomlTable keys(*value, keys_of("dynamics.plane"));
  Plane plane;
  plane.point = as_vector(keys.at("point_m"));
  plane.normal = as_vector(keys.at("normal"));
  if (!(plane.normal.norm() > 0)) refuse(keys.at("normal"), "has no length", "a vector other than 0");
  plane.normal.normalize();
  if (const auto friction = keys.find("friction")) {
    plane.friction = as_number(*friction, not_negative);
    if (plane.friction > 0 && motion.integrator != "explicit" && motion.integrator != "auto")
      refuse(*friction, fmt::format("does not suit the large steps of {}", motion.integrator),
             "friction = 0, or integrator = \"explicit\"");
  }
  motion.plane = plane;
}

/// A share of consistent mass: explicit steps, whose momenta have no impulses of a plane.
void read_mass(const TomlTable& table, MotionChoice& motion) {
  const auto value = table.find("mass_consistency");
  if (!value) return;
  motion.mass_consistency = as_number(*value, {"a share of consistent mass, 0 to 1", 0, 1, true, true});
  motion.mass_where = location_of(*value);
  if (motion.mass_consistency == 0) return;
  if (motion.integrator != "explicit")
    refuse(*value, fmt::format("does not suit the integrator {}, which has lumped mass", motion.integrator),
           "integrator = \"explicit\", or mass_consistency = 0");
  if (motion.plane) refuse(*value, "stands beside a plane, whose impulses need lumped mass", "one of the two");
}

/// One course at most, and none but a ramp for a body that is released.
void check_course(const TomlTable& table, const MotionChoice& motion) {
  const std::vector<std::string> courses = {"ramp_s", "pulse_s", "shake_Hz"};
  const std::string* first = nullptr;
  for (const std::string& name : courses) {
    const auto value = table.find(name);
    if (!value) continue;
    if (motion.released && name != "ramp_s")
      refuse(*value, "does not suit start = \"equilibrium\", whose loads are removed", "ramp_s");
    if (first)
      refuse(*value, fmt::format("stands beside {}", *first), "one of " + fmt::format("{}", fmt::join(courses, ", ")));
    first = &name;
  }
}

/// Rayleigh's damping: of mass and stiffness, each given, or both such that a vibration at either end of the band loses
/// the loss factor, in between less.  docs/motion.md.
void read_damping(const TomlTable& table, MotionChoice& motion) {
  const auto damping = table.find("damping_1_s"), viscosity = table.find("viscosity_s"),
             loss_factor = table.find("loss_factor"), band = table.find("band_Hz");
  if (damping) motion.damping = as_number(*damping, not_negative);
  if (viscosity) motion.viscosity = as_number(*viscosity, not_negative);
  if (!loss_factor && band) refuse(*band, "stands without loss_factor", "both, or neither");
  if (loss_factor) {
    for (const auto& other : {damping, viscosity})
      if (other) refuse(*other, "stands beside loss_factor, from which it would follow", "one of the two");
    const double eta = as_number(*loss_factor, {"a finite number >= 0, up to 1", 0, 1, true, true});
    if (!band)
      refuse(*loss_factor, "stands without band_Hz, the frequencies at which it holds", "band_Hz = [first, second]");
    const std::vector<TomlValue> ends = as_list_of(2, *band, "two frequencies [Hz]");
    const double first = 2 * std::numbers::pi * as_number(ends[0], positive_number),
                 second = 2 * std::numbers::pi * as_number(ends[1], positive_number);
    if (second < first) refuse(*band, "falls", "two frequencies > 0, the lower one first [Hz]");
    motion.damping = eta * first * second / (first + second);
    motion.viscosity = eta / (first + second);
  }
}

}  // namespace

std::vector<std::string> integrator_names() { return {"explicit", "energy_momentum", "implicit_euler", "auto"}; }

void read_dynamics(const TomlTable& document, Experiment& experiment) {
  const auto value = document.find("dynamics");
  if (experiment.reference.in_time && (!value || experiment.probes.empty()))
    refuse(document.at("reference"), "in_time integrates the motion of the case, and measures it at its probes",
           "with [dynamics] and a [[probe]] in the file");
  if (!value) return;
  const TomlTable table(*value, keys_of("dynamics"));
  if (experiment.model_kinematics() == Kinematics::linear)
    refuse(*value, "moves the models by their forces at large displacements, and the case has kinematics = \"linear\"",
           "with kinematics = \"hencky\", \"neo_hooke\" or another finite-strain law");
  if (document.find("fracture")) refuse(*value, "stands beside [fracture]", "one of the two");
  MotionChoice motion;
  motion.where = motion.integrator_where = location_of(*value);
  motion.duration = as_number(table.at("duration_s"), positive_number);
  if (const auto integrator = table.find("integrator")) {
    motion.integrator = as_choice(*integrator, integrator_names());
    motion.integrator_where = location_of(*integrator);
  }
  if (const auto start = table.find("start")) motion.released = as_choice(*start, {"rest", "equilibrium"}) != "rest";
  if (const auto step = table.find("time_step_s")) {
    motion.time_step = as_number(*step, {"a finite number > 0, up to duration_s", 0, motion.duration, false, true});
    motion.where = location_of(*step);
  }
  read_damping(table, motion);
  read_plane(table, experiment, motion);
  read_mass(table, motion);
  if (const auto ramp = table.find("ramp_s"))
    motion.course.ramp = as_number(*ramp, {"a finite number >= 0, up to duration_s", 0, motion.duration, true, true});
  if (const auto pulse = table.find("pulse_s"))
    motion.course.pulse = as_number(*pulse, {"a finite number > 0, up to duration_s", 0, motion.duration, false, true});
  if (const auto frequency = table.find("shake_Hz")) motion.course.frequency = as_number(*frequency, positive_number);
  check_course(table, motion);
  if (const auto velocity = table.find("velocity_m_s")) motion.velocity = as_vector(*velocity);
  if (const auto spin = table.find("spin_rad_s")) motion.spin = as_vector(*spin);
  if (const auto too = table.find("equilibrium")) motion.equilibrium = as_flag(*too);
  if (const auto samples = table.find("samples")) motion.samples = as_whole(*samples, 2, 100000);
  if (const auto frames = table.find("frames")) motion.frames = as_whole(*frames, 0, 1000);
  if (const double samples = 8 * motion.duration * motion.course.frequency;
      experiment.reference.in_time && motion.samples < samples)
    refuse(
        *value,
        fmt::format("has {} samples, and finite elements in time take eight to a period of shake_Hz", motion.samples),
        fmt::format("samples = {:.0f} or more", std::ceil(samples)));
  experiment.dynamics = motion;
}

std::vector<ModelChoice> with_motions(const std::vector<ModelChoice>& models, const MotionChoice& motion) {
  std::vector<ModelChoice> all;
  for (const ModelChoice& model : models) {
    if (motion.equilibrium) all.push_back(model);
    all.push_back(model);
    all.back().label += " in motion";
    all.back().in_motion = true;
  }
  return all;
}

}  // namespace springproof
