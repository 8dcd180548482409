#include "comparisons/bench/motion.h"

#include <fmt/format.h>

#include <algorithm>

#include "comparisons/bench/bodies.h"
#include "comparisons/bench/kernels/bench_kernel_choice.h"
#include "msm/dynamics/list_motion.h"
#include "msm/dynamics/time_step.h"
#include "msm/kernels/cell_forces.h"
#include "msm/kernels/list_forces.h"
#include "msm/laws/capabilities.h"

namespace springproof::bench {
namespace {

/// Time steps with forces(): the reference implementation, with whichever kernels forces() uses.
class Stepper {
 public:
  explicit Stepper(const MassSpringModel& model)
      : model_(model),
        dt_(0.5 * safe_time_step(model, density)),
        x_(moved(model.network)),
        v_(NodalVectors::Zero(x_.rows(), 3)),
        dt_over_mass_(dt_ * masses(model.network, density).cwiseInverse()) {}

  void advance(long steps) {
    for (; steps > 0; --steps) {
      const NodalVectors f = forces(model_, x_);
      for (Eigen::Index n = 0; n < x_.rows(); ++n) v_.row(n) += dt_over_mass_[n] * f.row(n);
      x_ += dt_ * v_;
    }
  }

 private:
  const MassSpringModel& model_;
  double dt_;
  NodalVectors x_, v_;
  Eigen::VectorXd dt_over_mass_;
};

struct PlainState {
  std::vector<PlainNode> nodes;
  std::vector<PlainSpring> springs;
  std::vector<double> dt_over_mass;
};

}  // namespace

Work operations(const MassSpringModel& model) {
  const Network& net = model.network;
  const double m = double(net.springs.size()), n = double(net.nodes());
  Work w{21 * m + 12 * n, m, 0, 0};
  if (law_of<VolumeCorrection>(model)) w.flops += 156 * double(net.cells.size());
  if (law_of<AveragedSprings>(model)) w.flops += 590 * double(net.cells.size());  // Hencky's curve
  if (law_of<MomentumDispersion>(model)) w.flops += 8 * m;
  return w;
}

namespace {

TimedStep new_motion(const std::string& how, const MassSpringModel& model, Precision precision) {
  return {how, {}, model.network.nodes(), long(model.network.springs.size()), operations(model), precision};
}

TimedStep timed_lattice(const MassSpringModel& model, const MotionOptions& options) {
  MotionOptions half = options;
  const double safe = safe_time_step(model, density, false, options.mass_consistency);
  half.time_step = 0.5 * viscous_time_step(model, density, options.viscosity, safe, options.mass_consistency);
  const std::shared_ptr<LatticeMotion> kernel = springproof::lattice_motion(model, density, half);
  const NodalVectors x = moved(model.network);
  kernel->set_state(x, NodalVectors::Zero(x.rows(), 3));
  TimedStep motion = new_motion(kernel->description(), model, options.precision);
  motion.work.streamed = (options.precision == Precision::float64 ? 96.0 : 48.0) * double(motion.nodes);
  motion.work.kept = kernel->bytes_per_node() * double(motion.nodes);
  motion.advance = [kernel](long steps) { kernel->advance(steps); };
  return motion;
}

template <class Real>
TimedStep motion_of_cells(const MassSpringModel& model, const MotionOptions& options) {
  const double safe = relaxing_time_step(model, density, options.relaxation, safe_time_step(model, density));
  const MotionOptions half = {.time_step = 0.5 * safe, .threads = options.threads};
  auto forces = std::make_unique<CellForces<Real>>(model);
  forces->set_branches(options.relaxation.relaxation, options.relaxation.cells, *half.time_step);
  const auto kernel = std::make_shared<ListMotion<Real>>(std::move(forces), model, density, half);
  const NodalVectors x = moved(model.network);
  kernel->set_state(x, NodalVectors::Zero(x.rows(), 3));
  TimedStep motion =
      new_motion(fmt::format("{}, {}{}", kernel->kernel(), name_of(instruction_set()),
                             kernel->threads() == 1 ? "" : fmt::format(", {} threads", kernel->threads())),
                 model, options.precision);
  const double c = double(model.network.cells.size()), n = double(motion.nodes), real = sizeof(Real),
               state = overstrain_count * double(options.relaxation.relaxation.branches.size());
  motion.work.streamed = ((10 + 2 * state) * real + 32) * c + 20 * real * n;
  motion.work.kept = ((10 + state) * real + 32) * c + (24 * real + 28) * n;
  motion.advance = [kernel](long steps) { kernel->advance(steps); };
  return motion;
}

/// Entries of the kernel are nearly as many as springs.
template <class Real>
TimedStep motion_of_springs(const MassSpringModel& model, const MotionOptions& options) {
  const MotionOptions half = {.time_step = 0.5 * safe_time_step(model, density), .threads = options.threads};
  const auto kernel =
      std::make_shared<ListMotion<Real>>(std::make_unique<ListForces<Real>>(model), model, density, half);
  kernel->set_conditions(clamped_bottom(model.network, 0.5 * edge));
  const int threads = kernel->threads();
  TimedStep motion = new_motion(fmt::format("list kernel, {}{}", name_of(instruction_set()),
                                            threads == 1 ? "" : fmt::format(", {} threads", threads)),
                                model, options.precision);
  const double m = double(motion.springs), n = double(motion.nodes), real = sizeof(Real);
  const bool disperses = dispersion_of(model) != nullptr;
  motion.work.streamed = disperses ? (10 * real + 10) * m + 49 * real * n : (2 * real + 5) * m + 20 * real * n;
  motion.work.kept = disperses ? (8 * real + 9) * m + (26 * real + 28) * n : (2 * real + 9) * m + (24 * real + 28) * n;
  motion.advance = [kernel](long steps) { kernel->advance(steps); };
  return motion;
}

}  // namespace

TimedStep motion_by_forces(const MassSpringModel& model) {
  TimedStep motion = new_motion("forces()", model, Precision::float64);
  const double m = double(motion.springs), n = double(motion.nodes);
  motion.work.streamed = 24 * m + 216 * n;
  motion.work.kept = 24 * m + 80 * n;
  const auto stepper = std::make_shared<Stepper>(model);
  motion.advance = [stepper](long steps) { stepper->advance(steps); };
  return motion;
}

std::optional<TimedStep> fastest_motion(const MassSpringModel& model, const MotionOptions& options) {
  if (LatticeMotion::suits(model, options)) return timed_lattice(model, options);
  if (options.viscosity.acts() || options.mass_consistency > 0) return {};
  if (can(model, Capability::list_kernels) && !options.relaxation.acts())
    return options.precision == Precision::float64 ? motion_of_springs<double>(model, options)
                                                   : motion_of_springs<float>(model, options);
  if (can(model, Capability::cell_kernels))
    return options.precision == Precision::float64 ? motion_of_cells<double>(model, options)
                                                   : motion_of_cells<float>(model, options);
  if (options.threads > 1 || options.precision != Precision::float64) return {};
  return motion_by_forces(model);
}

TimedStep plain_motion(const Network& network) {
  const MassSpringModel springs{network, {Springs{}}};
  const double dt = 0.5 * safe_time_step(springs, density);
  const auto state = std::make_shared<PlainState>();
  const NodalVectors x = moved(network);
  for (Eigen::Index i = 0; i < x.rows(); ++i) state->nodes.push_back({{x(i, 0), x(i, 1), x(i, 2)}, {}, {}});
  for (const Spring& s : network.springs) state->springs.push_back({s.i, s.j, s.stiffness, s.rest_length});
  for (const double mass : masses(network, density)) state->dt_over_mass.push_back(dt / mass);
  const double m = double(network.springs.size()), n = double(network.nodes());
  TimedStep motion{"plain loop", {}, network.nodes(), long(network.springs.size()), operations(springs)};
  motion.work.streamed = 24 * m + 296 * n;
  motion.work.kept = 24 * m + 80 * n;
  const auto step = kernels_of(instruction_set()).plain_step;
  motion.advance = [state, step, dt](long steps) {
    for (; steps > 0; --steps)
      step(state->nodes.data(), long(state->nodes.size()), state->springs.data(), long(state->springs.size()),
           state->dt_over_mass.data(), dt);
  };
  return motion;
}

namespace {

/// Lower bound [s] on the time that the arithmetic of a step takes on one core.
double arithmetic_limit(const TimedStep& motion, const Arithmetic& core) {
  const bool fp64 = motion.precision == Precision::float64;
  return std::max(1e-9 * motion.work.flops / (fp64 ? core.gflops64 : core.gflops32),
                  1e-9 * motion.work.roots * (fp64 ? core.root64 : core.root32));
}

}  // namespace

Usage usage_of(const TimedStep& motion, double seconds, const Machine& machine) {
  const MemoryLevel& level = machine.level_for(motion.work.kept);
  return {motion.work.kept / double(motion.nodes), 1e-9 * motion.work.streamed / seconds / level.GB_s,
          arithmetic_limit(motion, machine.widest()) / seconds};
}

}  // namespace springproof::bench
