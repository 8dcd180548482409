// The [dynamics] table.
#include <fmt/format.h>

#include "problem/case_file/experiment_parts.h"

namespace springproof {
namespace {

constexpr Key dynamics_schema[] = {{"duration_s", "a finite number > 0"},
                                   {"integrator"},
                                   {"start"},
                                   {"time_step_s"},
                                   {"damping_1_s"},
                                   {"ramp_s"},
                                   {"equilibrium"},
                                   {"samples"},
                                   {"frames"}};

}  // namespace

std::vector<std::string> integrator_names() {
  return {"explicit", "energy_momentum", "implicit_euler", "bdf2", "auto"};
}

void read_dynamics(const TomlTable& document, Experiment& experiment) {
  const auto value = document.find("dynamics");
  if (!value) return;
  const TomlTable table(*value, dynamics_schema);
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
  if (const auto damping = table.find("damping_1_s")) motion.damping = as_number(*damping, not_negative);
  if (const auto ramp = table.find("ramp_s"))
    motion.ramp = as_number(*ramp, {"a finite number >= 0, up to duration_s", 0, motion.duration, true, true});
  if (const auto too = table.find("equilibrium")) motion.equilibrium = as_flag(*too);
  if (const auto samples = table.find("samples")) motion.samples = as_whole(*samples, 2, 100000);
  if (const auto frames = table.find("frames")) motion.frames = as_whole(*frames, 0, 1000);
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
