#include "comparisons/bench/motion.h"

#include <fmt/format.h>

#include <algorithm>

#include "comparisons/bench/bodies.h"
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

/// One array of nodes, one of springs, a loop over each.
struct PlainSteps {
  double dt;
  std::vector<PlainNode> nodes = {};
  std::vector<PlainSpring> springs = {};
  std::vector<double> dt_over_mass = {};

  void advance(long steps) {
    for (const auto step = kernels_of(instruction_set()).plain_step; steps > 0; --steps)
      step(nodes.data(), long(nodes.size()), springs.data(), long(springs.size()), dt_over_mass.data(), dt);
  }
};

/// Operations of one step of the model, for any implementation; streamed and kept bytes.
Work work_of(const MassSpringModel& model, double streamed, double kept) {
  const Network& net = model.network;
  const double m = double(net.springs.size()), n = double(net.nodes());
  Work w{21 * m + 12 * n, m, streamed, kept};
  if (law_of<VolumeCorrection>(model)) w.flops += 156 * double(net.cells.size());
  if (law_of<AveragedSprings>(model)) w.flops += 590 * double(net.cells.size());  // Hencky's curve
  if (law_of<MomentumDispersion>(model)) w.flops += 8 * m;
  return w;
}

/// Steps of a kernel that has advance().
template <class Kernel>
TimedStep timed(const std::string& how, const MassSpringModel& model, const std::shared_ptr<Kernel>& kernel,
                double streamed, double kept, Precision precision = Precision::float64) {
  return {how,
          [kernel](long steps) { kernel->advance(steps); },
          model.network.nodes(),
          long(model.network.springs.size()),
          work_of(model, streamed, kept),
          precision};
}

std::string words_of(const std::string& kernel, int threads) {
  return fmt::format("{}, {}{}", kernel, name_of(instruction_set()),
                     threads == 1 ? "" : fmt::format(", {} threads", threads));
}

TimedStep timed_lattice(const MassSpringModel& model, const MotionOptions& options) {
  MotionOptions half = options;
  const double safe = safe_time_step(model, density, false, options.mass_consistency),
               n = double(model.network.nodes());
  half.time_step = 0.5 * viscous_time_step(model, density, options.viscosity, safe, options.mass_consistency);
  const std::shared_ptr<LatticeMotion> kernel = springproof::lattice_motion(model, density, half);
  const NodalVectors x = moved(model.network);
  kernel->set_state(x, NodalVectors::Zero(x.rows(), 3));
  return timed(kernel->description(), model, kernel, (options.precision == Precision::float64 ? 96.0 : 48.0) * n,
               kernel->bytes_per_node() * n, options.precision);
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
  const double c = double(model.network.cells.size()), n = double(model.network.nodes()), real = sizeof(Real),
               state = overstrain_count * double(options.relaxation.relaxation.branches.size());
  return timed(words_of(kernel->kernel(), kernel->threads()), model, kernel,
               ((10 + 2 * state) * real + 32) * c + 20 * real * n,
               ((10 + state) * real + 32) * c + (24 * real + 28) * n, options.precision);
}

/// Entries of the kernel are nearly as many as springs.
template <class Real>
TimedStep motion_of_springs(const MassSpringModel& model, const MotionOptions& options) {
  const MotionOptions half = {.time_step = 0.5 * safe_time_step(model, density), .threads = options.threads};
  const auto kernel =
      std::make_shared<ListMotion<Real>>(std::make_unique<ListForces<Real>>(model), model, density, half);
  kernel->set_conditions(clamped_bottom(model.network, 0.5 * edge));
  const double m = double(model.network.springs.size()), n = double(model.network.nodes()), real = sizeof(Real);
  const bool disperses = dispersion_of(model) != nullptr;
  return timed(words_of("list kernel", kernel->threads()), model, kernel,
               disperses ? (10 * real + 10) * m + 49 * real * n : (2 * real + 5) * m + 20 * real * n,
               disperses ? (8 * real + 9) * m + (26 * real + 28) * n : (2 * real + 9) * m + (24 * real + 28) * n,
               options.precision);
}

}  // namespace

TimedStep motion_by_forces(const MassSpringModel& model) {
  const double m = double(model.network.springs.size()), n = double(model.network.nodes());
  return timed("forces()", model, std::make_shared<Stepper>(model), 24 * m + 216 * n, 24 * m + 80 * n);
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
  const MassSpringModel model{network, {Springs{}}};
  const auto steps = std::make_shared<PlainSteps>(PlainSteps{0.5 * safe_time_step(model, density)});
  const NodalVectors x = moved(network);
  for (Eigen::Index i = 0; i < x.rows(); ++i) steps->nodes.push_back({{x(i, 0), x(i, 1), x(i, 2)}, {}, {}});
  for (const Spring& s : network.springs) steps->springs.push_back({s.i, s.j, s.stiffness, s.rest_length});
  for (const double mass : masses(network, density)) steps->dt_over_mass.push_back(steps->dt / mass);
  const double m = double(network.springs.size()), n = double(network.nodes());
  return timed("plain loop", model, steps, 24 * m + 296 * n, 24 * m + 80 * n);
}

Usage usage_of(const TimedStep& motion, double seconds, const Machine& machine) {
  const auto& [flops, roots, streamed, kept] = motion.work;
  const Arithmetic& core = machine.widest();
  const bool fp64 = motion.precision == Precision::float64;
  const double least = std::max(1e-9 * flops / (fp64 ? core.gflops64 : core.gflops32),
                                1e-9 * roots * (fp64 ? core.root64 : core.root32));  // by the arithmetic of one core
  return {kept / double(motion.nodes), 1e-9 * streamed / seconds / machine.level_for(kept).GB_s, least / seconds};
}

}  // namespace springproof::bench
