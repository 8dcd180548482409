#include "comparisons/bench/engine_ours.h"

#include <Eigen/Geometry>
#include <cmath>

#include "comparisons/bench/timer.h"
#include "msm/dynamics/time_step.h"
#include "msm/embedding/boundary.h"
#include "msm/models.h"
#include "msm/statics/equilibrium.h"

namespace springproof::bench {
namespace {

EngineSample sample_of(double time, const EngineBar& bar, const NodalVectors& x, const NodalVectors& v) {
  EngineSample s{time, 0, Vec3::Zero(), Vec3::Zero()};
  const Vec3 centre = bar.mesh.nodes.colwise().mean().transpose();
  for (Eigen::Index n = 0; n < x.rows(); ++n) {
    const Vec3 w = v.row(n).transpose(), r = x.row(n).transpose() - centre;
    s.kinetic_energy += 0.5 * bar.mass[n] * w.squaredNorm();
    s.spin += bar.mass[n] * r.cross(w);
  }
  for (std::size_t i = 0; i < bar.watched.size(); ++i) s.tip += bar.weights[i] * x.row(bar.watched[i]).transpose();
  return s;
}

}  // namespace

MassSpringModel model_of_bar(const std::string& name, const EngineBar& bar, double poisson_ratio) {
  return build_model(resolve({name, {}, name, {}}), bar.mesh, bar_material(poisson_ratio));
}

NodalVectors equilibrium_of_bar(const MassSpringModel& model, const EngineBar& bar, BarLoad load) {
  const BoundaryConditions conditions = transfer(loads_of(load), bar.mesh, bar_material(0).density, Kinematics::linear);
  const Equilibrium e = solve_linear(model, conditions);
  if (!e.ok) throw std::runtime_error(e.message);
  return e.displacement;
}

double finite_tip(const MassSpringModel& model, const EngineBar& bar) {
  const Equilibrium e = solve_finite(model,
                                     [&](double factor) {
                                       return transfer(loads_of(BarLoad::gravity), bar.mesh, bar_material(0).density,
                                                       Kinematics::finite, factor);
                                     },
                                     {.tolerance = 1e-11});
  if (!e.ok) throw std::runtime_error(e.message);
  return measure_of(BarLoad::gravity, bar, e.displacement);
}

EngineAnswer run_ours(const MassSpringModel& model, const EngineBar& bar, const EngineTask& task) {
  EngineAnswer out;
  const NodalVectors& X = bar.mesh.nodes;
  for (const NodalVectors& u : task.fields) out.forces.push_back((forces(model, X + u) - forces(model, X - u)) / 2);
  const int parts = int(std::ceil(task.time_step / (0.9 * safe_time_step(model, bar_material(0).density))));
  const double h = task.time_step / parts, decay = std::exp(-task.damping * task.time_step);
  NodalVectors x = X, v = task.velocities.rows() > 0 ? task.velocities : NodalVectors::Zero(X.rows(), 3);
  const NodalVectors push = task.forces.rows() > 0 ? task.forces : NodalVectors::Zero(X.rows(), 3);
  const auto hold = [&] {
    for (Eigen::Index n = 0; task.pinned && n < x.rows(); ++n)
      if (X(n, 0) == 0) v.row(n).setZero();
  };
  hold();
  out.samples.push_back(sample_of(0, bar, x, v));
  const long every = std::max(1L, std::lround(1.0 / 60 / task.time_step));
  for (long step = 1; step <= task.steps(); ++step) {
    const double start = seconds_of(Clock::thread);
    for (int i = 0; i < parts; ++i) {
      v += h * ((forces(model, x) + push).array().colwise() / bar.mass.array()).matrix();
      v.col(2).array() -= h * task.gravity;
      hold();
      x += h * v;
    }
    out.seconds += seconds_of(Clock::thread) - start;
    if (step <= task.steps() - std::lround(task.free / task.time_step)) v *= decay;
    if (step % every == 0 || step == task.steps())
      out.samples.push_back(sample_of(double(step) * task.time_step, bar, x, v));
  }
  out.x = x;
  out.steps = task.steps() * parts;
  out.burst = !x.allFinite();
  return out;
}

}  // namespace springproof::bench
