// The [dynamics], [fracture] and [relaxation] tables: what the body does in time.
#include <fmt/format.h>

#include <algorithm>
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

constexpr const char* branch_words = "a list of up to 8 { share, time_s }";
constexpr std::size_t most_branches = 8;

std::vector<RelaxationBranch> read_branches(const TomlValue& value) {
  const std::vector<TomlValue> items = as_list(value, branch_words);
  if (items.size() > most_branches) refuse(value, fmt::format("has {} branches", items.size()), branch_words);
  std::vector<RelaxationBranch> branches;
  for (const TomlValue& item : items) {
    const TomlTable table(item, keys_of("material.relaxation.branches"));
    const RelaxationBranch branch{as_number(table.at("share"), {"a number from 1e-6 to 1000", 1e-6, 1000, true, true}),
                                  as_number(table.at("time_s"), positive_number)};
    if (std::ranges::any_of(branches, [&](const auto& other) { return other.time == branch.time; }))
      refuse(table.at("time_s"), fmt::format("{} s is that of another branch", branch.time),
             "one branch of each time, with the sum of their shares");
    branches.push_back(branch);
  }
  return branches;
}

int as_count(const TomlValue& value, double most) {
  const std::string words = fmt::format("a whole number from 1 to {:g}", most);
  const double x = as_number(value, {words.c_str(), 1, most, true, true});
  if (x != static_cast<double>(static_cast<int>(x))) refuse(value, fmt::format("is {}", x), words);
  return static_cast<int>(x);
}

/// A drying body is held at rest and carries no load.
void check_supports(const Experiment& e) {
  for (std::size_t i = 0; i < e.loads.size(); ++i) {
    const auto* held = std::get_if<PrescribedDisplacement>(&e.loads[i]);
    const std::array<std::optional<double>, 3> at_rest = {0.0, 0.0, 0.0};
    if (!held || held->displacement != at_rest)
      throw InputError(e.load_locations[i],
                       "load: cannot act on a body that dries (allowed beside [fracture]: displacement_m = [0, 0, 0])");
  }
}

}  // namespace

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
    motion.integrator = as_choice(*integrator, {"explicit", "energy_momentum", "implicit_euler", "auto"});
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

void read_relaxation(const TomlTable& document, Experiment& experiment) {
  const auto value = TomlTable(document.at("material"), keys_of("material")).find("relaxation");
  if (!value) return;
  if (document.find("fracture"))
    refuse(*value, "stands beside [fracture], whose springs do not relax", "one of the two");
  const TomlTable table(*value, keys_of("material.relaxation"));
  experiment.relaxation.branches = read_branches(table.at("branches"));
  experiment.relaxation_where = location_of(*value);
  const auto after = table.find("equilibrium_after_s");
  if (!after) return;
  if (experiment.dynamics)
    refuse(*after, "stands beside [dynamics], whose motions end at equilibria of long times", "one of the two");
  experiment.loaded_for = as_number(*after, positive_number);
}

void check_relaxation(const Experiment& e) {
  const auto is_exact = [](const Load& load) {
    const auto* field = std::get_if<PrescribedField>(&load);
    return field && field->kelvin;
  };
  if (!e.relaxation.acts() || !(e.line || std::ranges::any_of(e.loads, is_exact))) return;
  throw InputError(e.relaxation_where,
                   "material.relaxation: stands beside an exact line or field, which is of a material that does not "
                   "relax (allowed: one of the two)");
}

void read_fracture(const TomlTable& document, Experiment& experiment) {
  const auto value = document.find("fracture");
  if (!value) return;
  const TomlTable table(*value, keys_of("fracture"));
  Fracture f;
  f.shrinkage = as_number(table.at("shrinkage"), {"a number from 0 to 0.5", 0, 0.5, true, true});
  f.threshold = as_number(table.at("threshold"), {"a number > 0, up to 1", 0, 1, false, true});
  if (const auto given = table.find("steps")) f.steps = as_count(*given, 1e5);
  if (const auto given = table.find("depth_m")) f.depth = as_number(*given, positive_number);
  if (const auto given = table.find("scatter"))
    f.scatter = as_number(*given, {"a number from 0 to 0.5", 0, 0.5, true, true});
  if (const auto given = table.find("apart")) f.apart = as_number(*given, not_negative);
  if (const auto given = table.find("seed")) f.seed = static_cast<std::uint64_t>(as_count(*given, 1e9));
  if (const auto given = table.find("seeds")) f.seeds = as_count(*given, 1000);
  // In a larger step all springs of an even body would reach their threshold at once.
  if (f.shrinkage / f.steps > f.threshold)
    refuse(table.at("shrinkage"),
           fmt::format("is {:.4g} in each of {} steps, beyond the threshold", f.shrinkage / f.steps, f.steps),
           fmt::format("shrinkage / steps up to the threshold, {:.4g}", f.threshold));
  if (experiment.kinematics != "linear")
    refuse(*value, fmt::format("does not go with kinematics = \"{}\"", experiment.kinematics), "\"linear\"");
  for (const char* other : {"reference", "line", "section", "probe"})
    if (const auto given = document.find(other))
      refuse(*given, "does not go with [fracture]", "no such table: springs alone break");
  check_supports(experiment);
  experiment.fracture = f;
  experiment.reference.elements.clear();
  experiment.elements.clear();
}

}  // namespace springproof
