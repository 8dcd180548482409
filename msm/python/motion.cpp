// Python: motion in time.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "msm/dynamics/dynamics.h"
#include "msm/dynamics/inertia.h"
#include "msm/python/bindings.h"
#include "problem/system/run_cost.h"

namespace springproof::python {
namespace {

using namespace py::literals;

constexpr int steps_of_moved_supports = 3;     // that which moves them, that which stops them, and one without force
constexpr long nodes_between_looks = 2000000;  // nodes times steps until the next look for Ctrl-C, some 50 ms

/// A model in motion, with copies of its state for Python that are renewed when they are asked for.
class MovingModel {
 public:
  /// @param conditions of nodes, and the factor of these and of the loads at the start
  MovingModel(ModelPointer model, std::vector<Load> loads, std::pair<NodeConditions, double> conditions,
              DynamicsOptions options)
      : model_(std::move(model)),
        loads_(std::move(loads)),
        nodes_(std::move(conditions.first)),
        factor_(finite(conditions.second, "load_factor")) {
    const double density = model_->springs.density;
    options.relaxation = model_->springs.relaxing;
    options.time_step = dt_ = checked_time_step(model_->model(), density, options);
    motion_ = make_motion(model_->model(), density, options);
    apply();
    of_supports_.emplace(model_->network(), options, conditions_.prescribed);
    const NodalVectors& X = model_->network().X;
    options.velocity = NodalVectors::Zero(X.rows(), 3);
    set_state(X, velocity_before(model_->model(), density, X, conditions_, options));
    motion_->move_supports();
  }

  void step(long n) {
    if (n < 0) throw InputError(fmt::format("n: is {} steps (allowed: 0 or more)", n));
    const long chunk = std::max(1L, nodes_between_looks / std::max(1, model_->network().nodes()));
    while (n > 0) {
      const long now = carry_supports() ? 1 : std::min(n, chunk);
      const ForceNorms norms = motion_->advance(now);
      n -= now;
      steps_ += now;
      fresh_x_ = fresh_v_ = fresh_f_ = false;
      if (const std::string why = motion_->failure(); !why.empty()) throw SolveError(why);
      if (!std::isfinite(norms.unbalanced) || !std::isfinite(norms.support))
        throw SolveError(fmt::format("the motion diverged at t = {:.4g} s", time()));
      if (n > 0) check_interruption();
    }
  }

  void set_state(NodalVectors x, NodalVectors v) {
    for (Eigen::Index i = 0; i < x.size(); ++i)
      if (conditions_.fixed[i]) {
        x.data()[i] = model_->network().X.data()[i] + conditions_.prescribed.data()[i];
        v.data()[i] = 0;
      }
    motion_->set_state(x, v);
    fresh_x_ = fresh_v_ = fresh_f_ = false;
  }
  void set_forces(NodalVectors forces) {
    nodes_.forces = std::move(forces);
    apply();
  }
  void set_load_factor(double factor) {
    factor_ = finite(factor, "factor");
    apply();
    moved_for_ = steps_of_moved_supports;
  }

  const NodalVectors& positions() const {
    return renew(x_, fresh_x_, [&] { return motion_->positions(); });
  }
  const NodalVectors& velocities() const {
    return renew(v_, fresh_v_, [&] { return motion_->velocities(); });
  }
  const NodalVectors& forces() const {
    return renew(f_, fresh_f_, [&] {
      const NodalVectors of_branches = motion_->relaxing_forces();
      NodalVectors f = springproof::forces(model_->model(), positions());
      if (of_branches.size() > 0) f += of_branches;
      return f;
    });
  }
  double kinetic_energy() const {
    return 0.5 * (velocities().rowwise().squaredNorm().array() * model_->mass.array()).sum();
  }
  double elastic_energy() const { return energy(model_->model(), positions()); }
  double time() const { return static_cast<double>(steps_) * dt_; }
  double time_step() const { return dt_; }
  long steps() const { return steps_; }
  std::string description() const { return motion_->description(); }
  const BodyModel& model() const { return *model_; }

  /// CPU time of n steps that C++ makes one after the other, per step [s]: what a call from Python is compared with.
  double seconds_per_step(long n) {
    const double start = cpu_seconds();
    for (long i = 0; i < n; ++i) motion_->advance(1);
    const double seconds = cpu_seconds() - start;
    steps_ += n;
    fresh_x_ = fresh_v_ = fresh_f_ = false;
    return seconds / static_cast<double>(n);
  }

 private:
  void apply() {
    const Kinematics kinematics = model_->model().small_displacements_only ? Kinematics::linear : Kinematics::finite;
    conditions_ = conditions_of(*model_, loads_, nodes_, kinematics, factor_);
    motion_->set_conditions(conditions_);
  }

  /// Sets the forces that move the support masses in the step to come; false: supports have rested for two steps.
  bool carry_supports() {
    if (!of_supports_->acts() || moved_for_ == 0) return false;
    --moved_for_;
    BoundaryConditions with_inertia = conditions_;
    of_supports_->add(with_inertia);
    motion_->set_conditions(with_inertia);
    return true;
  }

  /// Into the same memory, which views of Python refer to.
  template <class Make>
  static const NodalVectors& renew(NodalVectors& kept, bool& fresh, const Make& make) {
    if (fresh) return kept;
    if (kept.size() == 0)
      kept = make();
    else
      std::copy_n(make().data(), kept.size(), kept.data());
    fresh = true;
    return kept;
  }

  ModelPointer model_;
  std::vector<Load> loads_;
  NodeConditions nodes_;
  BoundaryConditions conditions_;
  double factor_, dt_ = 0;
  std::unique_ptr<Motion> motion_;
  std::optional<SupportInertia> of_supports_;
  int moved_for_ = 0;  ///< steps for which the support masses still have forces to be set
  long steps_ = 0;
  mutable NodalVectors x_, v_, f_;
  mutable bool fresh_x_ = false, fresh_v_ = false, fresh_f_ = false;
};

Integrator integrator_of(const std::string& name) {
  if (name == "explicit") return Integrator::explicit_euler;
  if (name == "energy_momentum") return Integrator::energy_momentum;
  if (name == "implicit_euler") return Integrator::implicit_euler;
  throw InputError(fmt::format("integrator: is '{}' (allowed: explicit, energy_momentum, implicit_euler)", name));
}

std::shared_ptr<MovingModel> motion_of(const ModelPointer& model, const std::vector<BoundLoad>& loads,
                                       const py::object& held, const py::object& displacement, const py::object& forces,
                                       double load_factor, std::optional<double> time_step, double damping,
                                       const std::string& integrator, bool float32, int threads) {
  if (threads < 1 || threads > 1024) throw InputError(fmt::format("threads: is {} (allowed: 1 to 1024)", threads));
  DynamicsOptions options;
  options.integrator = integrator_of(integrator);
  options.time_step = time_step;
  options.damping = damping;
  options.precision = float32 ? Precision::float32 : Precision::float64;
  options.threads = threads;
  NodeConditions nodes = node_conditions(*model, held, displacement, forces);
  return long_call([&] {
    return std::make_shared<MovingModel>(model, loads_of(*model, loads), std::pair(std::move(nodes), load_factor),
                                         options);
  });
}

}  // namespace

void bind_motion(py::module_& m, py::class_<BodyModel, std::shared_ptr<BodyModel>>& model) {
  py::class_<MovingModel, std::shared_ptr<MovingModel>>(m, "Motion", R"(A model in motion; made by Model.motion().

The arrays are views of one piece of memory each, which is renewed when the attribute is read: read it again after a step, and
copy what is to be kept.)")
      .def("step", &MovingModel::step, "n"_a = 1, py::call_guard<py::gil_scoped_release>(),
           "n time steps.  Raises SolveError if the motion diverges.")
      .def(
          "set_state",
          [](MovingModel& s, const Numbers& positions, const Numbers& velocities) {
            const int n = s.model().network().nodes();
            s.set_state(rows_of(positions, "positions", n), rows_of(velocities, "velocities", n));
          },
          "positions"_a, "velocities"_a,
          "Puts all nodes that are not held there, n x 3 [m] and [m/s]; velocities as the attribute gives them.")
      .def(
          "set_forces",
          [](MovingModel& s, const Numbers& forces) {
            s.set_forces(finite(rows_of(forces, "forces", s.model().network().nodes()), "forces"));
          },
          "forces"_a, "Forces on the nodes, n x 3 [N], from now on, beside the loads; instead of those given before.")
      .def("set_load_factor", &MovingModel::set_load_factor, "factor"_a,
           "From now on loads, displacements of supports and forces are this much of theirs; the next step ends there. "
           "Call it before each step to move supports.")
      .def_property_readonly(
          "positions", [](const py::object& self) { return view(self.cast<MovingModel&>().positions(), self); },
          "n x 3 [m]; a view, renewed when read")
      .def_property_readonly(
          "velocities", [](const py::object& self) { return view(self.cast<MovingModel&>().velocities(), self); },
          "n x 3 [m/s], of explicit steps half a step before the positions; a view, renewed when read")
      .def_property_readonly(
          "forces", [](const py::object& self) { return view(self.cast<MovingModel&>().forces(), self); },
          "internal forces, n x 3 [N]; a view, renewed when read")
      .def_property_readonly("kinetic_energy", &MovingModel::kinetic_energy, "[J]")
      .def_property_readonly("elastic_energy", &MovingModel::elastic_energy,
                             "[J] of a model whose forces have a potential")
      .def_property_readonly("time", &MovingModel::time, "since the start [s]")
      .def_property_readonly("time_step", &MovingModel::time_step, "[s]")
      .def_property_readonly("steps", &MovingModel::steps, "since the start")
      .def_property_readonly("description", &MovingModel::description, "which loop runs")
      .def("_seconds_per_step", &MovingModel::seconds_per_step, "n"_a,
           "CPU time of a step, of n made by a loop of C++ [s].");
  model.def("motion", &motion_of, "loads"_a = std::vector<BoundLoad>(), py::kw_only(), "held"_a = py::none(),
            "displacement"_a = py::none(), "forces"_a = py::none(), "load_factor"_a = 1.0, "time_step"_a = py::none(),
            "damping"_a = 0.0, "integrator"_a = "explicit", "float32"_a = false, "threads"_a = 1,
            R"(The model in motion from rest, under loads and supports as of solve().

load_factor: of all of these at the start (Motion.set_load_factor);
time_step [s]: default 0.95 of safe_time_step (10 of it where the integrator is implicit: "energy_momentum",
"implicit_euler"); damping: in proportion to the mass [1/s]; float32: kernels in single precision.
Raises InputError for an explicit step above safe_time_step, which the message names.)");
}

}  // namespace springproof::python
