#include "comparisons/run/motion_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "comparisons/run/sampling.h"
#include "comparisons/run/voxel_body.h"
#include "msm/dynamics/dynamics.h"
#include "msm/dynamics/time_step.h"
#include "problem/system/progress.h"

namespace springproof {
namespace {

constexpr double most_steps = 1e8;

/// The steps of a motion.
struct Steps {
  double size;  ///< [s]
  long stride;  ///< from one sample of the history to the next
};

Steps steps_of(const MotionChoice& motion, const MassSpringModel& model, const IsotropicMaterial& material) {
  const double bound = safe_time_step(model, material.density), size = motion.time_step.value_or(0.95 * bound);
  if (size > bound)
    throw InputError(
        motion.where,
        fmt::format("dynamics.time_step_s: {:.6g} s is not safe for a model of the case at nu = {} "
                    "(allowed: up to {:.6g} s, the bound of its springs and cells, or no time_step_s: each "
                    "model then has its own)",
                    size, material.poisson_ratio, bound));
  const double count = std::ceil(motion.duration / size);
  if (count > most_steps)
    throw InputError(motion.where, fmt::format("dynamics.duration_s: takes {:.3g} steps of {:.3g} s (allowed: up to "
                                               "{:.0g} steps)",
                                               count, size, most_steps));
  return {size, std::max(1L, static_cast<long>(count) / motion.samples)};
}

/// Records the motion of one network, sample by sample.
class Recorder {
 public:
  Recorder(const PreparedCase& prepared, const Lattice& lattice, const EmbeddedModel& built,
           const IsotropicMaterial& material, MotionRecord& record)
      : prepared_(prepared),
        lattice_(lattice),
        built_(built),
        mass_(masses(built.model.network, material.density)),
        record_(record) {}

  void operator()(double time, const NodalVectors& x, const NodalVectors& v, const BoundaryConditions& conditions) {
    record_.history.time.push_back(time);
    const Field field = field_at(x, conditions);
    next_ = 0;
    add("kinetic_energy", "J", 0.5 * (v.rowwise().squaredNorm().array() * mass_.array()).sum());
    if (conservative(built_.model)) add("elastic_energy", "J", energy(built_.model, x));
    const NodalVectors u = x - built_.model.network.X;
    add("load_potential", "J", -conditions.external.cwiseProduct(u).sum());
    add("volume_change", "1", field.volume_change);
    for (const PatchReaction& r : field.reactions) add_vector("force." + r.patch, "N", r.force);
    const std::vector<Probe>& probes = prepared_.experiment.probes;
    const NodalVectors at_points = at_measured_points(prepared_, lattice_, field.displacement);
    for (std::size_t p = 0; p < probes.size(); ++p)
      add_vector("displacement." + probes[p].name, "m", at_points.row(static_cast<Eigen::Index>(p)).transpose());
    const MotionChoice& motion = *prepared_.experiment.dynamics;
    if (time * motion.frames >= (record_.frames.size() + 1) * motion.duration * (1 - 1e-9))
      record_.frames.emplace_back(time, field.displacement);
  }

 private:
  Field field_at(const NodalVectors& x, const BoundaryConditions& conditions) const {
    const MassSpringModel& model = built_.model;
    Equilibrium state;
    state.displacement = x - model.network.X;
    state.support = support_forces(model, x, conditions);
    const Experiment& e = prepared_.experiment;
    Field field = to_field(state, lattice_.mesh, built_.embedding, model.network, prepared_.loads, conditions,
                           e.model_kinematics());
    if (e.body.is_voxels()) field.reactions = about_true_patches(prepared_, *lattice_.mesh, field.reactions);
    return field;
  }

  void add(const std::string& name, const char* unit, double value) {
    HistoryRecord& h = record_.history;
    if (next_ == h.names.size()) {
      h.names.push_back(name);
      h.units.emplace_back(unit);
      h.values.emplace_back();
    }
    h.values[next_++].push_back(value);
  }

  void add_vector(const std::string& name, const char* unit, const Vec3& v) {
    for (int axis = 0; axis < 3; ++axis) add(fmt::format("{}.{}", name, "xyz"[axis]), unit, v[axis]);
  }

  const PreparedCase& prepared_;
  const Lattice& lattice_;
  const EmbeddedModel& built_;
  Eigen::VectorXd mass_;
  MotionRecord& record_;
  std::size_t next_ = 0;  ///< quantity
};

}  // namespace

void check_motion(const MotionChoice& motion, const MassSpringModel& model, const IsotropicMaterial& material) {
  steps_of(motion, model, material);
}

Equilibrium run_motion(const PreparedCase& prepared, const Lattice& lattice, const EmbeddedModel& built,
                       const IsotropicMaterial& material, const LoadPath& path, MotionRecord& record) {
  const MotionChoice& motion = *prepared.experiment.dynamics;
  const Steps steps = steps_of(motion, built.model, material);
  record.history.time_step = steps.size;
  Recorder recorder(prepared, lattice, built, material, record);
  DynamicsOptions options;
  options.time_step = steps.size;
  options.damping = motion.damping;
  options.ramp = motion.ramp;
  options.duration = motion.duration;
  options.stride = steps.stride;
  options.after_step = [&](double time, const NodalVectors& x, const NodalVectors& v, const BoundaryConditions& bc) {
    recorder(time, x, v, bc);
    progress::detail(fmt::format("{:.3g} of {:.3g} s", time, motion.duration));
  };
  return run_dynamics(built.model, material.density, path, options).state;
}

}  // namespace springproof
