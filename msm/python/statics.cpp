// Python: loads, supports and equilibrium.
#include <fmt/format.h>

#include <cmath>

#include "meshes/volume.h"
#include "msm/embedding/cut_lattice.h"
#include "msm/python/bindings.h"

namespace springproof::python {
namespace {

using namespace py::literals;

/// An equilibrium of a model.
struct SolvedState {
  ModelPointer model;
  Equilibrium equilibrium;
  NodalVectors on_body;                  ///< displacement of the body's nodes [m]
  std::vector<PatchReaction> reactions;  ///< of the patches that loads hold
  double volume_change = 0;
};

void require_large(const BodyModel& model) {
  if (!model.model().small_displacements_only) return;
  std::string able;
  for (const ModelRow& row : model_table())
    if (can(row, Capability::large_displacements)) able += (able.empty() ? "" : ", ") + row.name;
  throw InputError(fmt::format("{} holds under small displacements only, and large = True (allowed: {})",
                               model.parameters.row.name, able));
}

std::shared_ptr<SolvedState> solve(const ModelPointer& model, const std::vector<BoundLoad>& given,
                                   const py::object& held, const py::object& displacement, const py::object& forces,
                                   bool large) {
  if (large) require_large(*model);
  const std::vector<Load> loads = loads_of(*model, given);
  const NodeConditions nodes = node_conditions(*model, held, displacement, forces);
  const Kinematics kinematics = large ? Kinematics::finite : Kinematics::linear;
  const LoadPath path = [&](double factor) { return conditions_of(*model, loads, nodes, kinematics, factor); };
  auto solved = std::make_shared<SolvedState>();
  solved->model = model;
  long_call([&] {
    const BoundaryConditions conditions = path(1);
    require_supported(conditions, model->network().X);
    Equilibrium& state = solved->equilibrium;
    state = large ? solve_finite(model->model(), path) : solve_linear(model->model(), conditions);
    if (!state.ok) throw SolveError(fmt::format("{}: {}", model->parameters.row.name, state.message));
    if (!model->body) return 0;
    const Field field =
        to_field(state, model->body->mesh, model->embedding, model->network(), loads, conditions, kinematics);
    solved->on_body = field.displacement;
    solved->reactions = field.reactions;
    const bool own_field = model->network().cells.cut();
    solved->volume_change = own_field ? volume_change(model->network(), state.displacement).exact : field.volume_change;
    return 0;
  });
  return solved;
}

py::array displacement_at_points(const SolvedState& s, const Numbers& points) {
  const NodalVectors at = rows_of(points, "points");
  if (!s.model->body) throw InputError("points: the model has no body (allowed: displacement, of the nodes)");
  if (s.model->network().cells.cut())
    return moved(springproof::displacement_at(*s.model->body->cut, s.equilibrium.displacement, at));
  const Mesh& mesh = *s.model->body->mesh;
  const Locator locate(mesh);
  NodalVectors out = NodalVectors::Zero(at.rows(), 3);
  for (Eigen::Index i = 0; i < at.rows(); ++i) {
    const Location in = locate(at.row(i).transpose());
    for (int n = 0; n < 8; ++n) out.row(i) += in.shape[n] * s.on_body.row(mesh.hexahedra[in.cell][n]);
  }
  return moved(std::move(out));
}

py::dict reactions_of(const SolvedState& s) {
  py::dict out;
  for (const PatchReaction& r : s.reactions) {
    NodalVectors pair(2, 3);
    pair.row(0) = r.force.transpose();
    pair.row(1) = r.torque.transpose();
    out[py::str(r.patch)] = moved(std::move(pair));
  }
  return out;
}

void bind_state(py::module_& m) {
  py::class_<SolvedState, std::shared_ptr<SolvedState>>(m, "State", "An equilibrium; made by Model.solve().")
      .def_property_readonly(
          "displacement",
          [](const py::object& self) { return view(self.cast<SolvedState&>().equilibrium.displacement, self); },
          "of the model's nodes, n x 3 [m]; a view")
      .def_property_readonly(
          "support", [](const py::object& self) { return view(self.cast<SolvedState&>().equilibrium.support, self); },
          "force of the supports on each node, n x 3 [N]; a view")
      .def_property_readonly(
          "body_displacement", [](const py::object& self) { return view(self.cast<SolvedState&>().on_body, self); },
          "of the body's nodes (Body.nodes), 3 columns [m]; a view; no rows for a model without a body")
      .def("at", &displacement_at_points, "points"_a, "Displacement of points of the body, k x 3 [m].")
      .def_property_readonly(
          "reactions", &reactions_of,
          "patch -> force [N] and torque [N m] of its support, about the centroid of the patch at rest, 2 x 3")
      .def_readonly("volume_change", &SolvedState::volume_change, "(V' - V)/V of the deformed cells")
      .def_property_readonly("solver", [](const SolvedState& s) { return s.equilibrium.solver; })
      .def_property_readonly(
          "residual", [](const SolvedState& s) { return s.equilibrium.residual; },
          "unbalanced force over the scale of the forces")
      .def_property_readonly(
          "iterations", [](const SolvedState& s) { return s.equilibrium.iterations; },
          "of the linear solver; large displacements: of Newton's method")
      .def_property_readonly(
          "seconds", [](const SolvedState& s) { return s.equilibrium.seconds; }, "CPU time");
}

}  // namespace

std::vector<Load> loads_of(const BodyModel& model, const std::vector<BoundLoad>& given) {
  std::vector<Load> loads;
  for (const BoundLoad& load : given) std::visit([&](const auto& l) { loads.emplace_back(l); }, load);
  for (const AttachedMass& mass : model.masses)
    for (Load& weight : weight_of(mass, loads)) loads.push_back(std::move(weight));
  return loads;
}

NodeConditions node_conditions(const BodyModel& model, const py::object& held, const py::object& displacement,
                               const py::object& forces) {
  NodeConditions out;
  const int n = model.network().nodes();
  if (!held.is_none()) {
    py::array given = py::array::ensure(held);
    if (given && given.dtype().kind() == 'b' && given.size() == n)
      given = py::module_::import("numpy").attr("flatnonzero")(given);
    if (!given || given.ndim() > 1 || (given.size() > 0 && given.dtype().kind() != 'i' && given.dtype().kind() != 'u'))
      throw InputError(
          fmt::format("held: is no list of nodes (allowed: whole numbers from 0 to {}, or {} flags)", n - 1, n));
    for (const py::handle node : given.attr("ravel")()) {
      const long i = node.cast<long>();
      if (i < 0 || i >= n) throw InputError(fmt::format("held: node {} (allowed: 0 to {})", i, n - 1));
      out.held.push_back(static_cast<int>(i));
    }
  }
  const auto count = static_cast<Eigen::Index>(out.held.size());
  out.displacement = NodalVectors::Zero(count, 3);
  if (!displacement.is_none()) {
    const auto given = displacement.cast<Numbers>();
    if (given.ndim() == 1)
      out.displacement.rowwise() = vector_of(given, "displacement").transpose();
    else
      out.displacement = rows_of(given, "displacement", count);
  }
  if (out.displacement.array().isInf().any())
    throw InputError("displacement: a number is infinite (allowed: finite numbers, NaN: free)");
  if (!forces.is_none()) out.forces = finite(rows_of(forces.cast<Numbers>(), "forces", n), "forces");
  return out;
}

BoundaryConditions conditions_of(const BodyModel& model, const std::vector<Load>& loads, const NodeConditions& nodes,
                                 Kinematics kinematics, double factor) {
  const Network& network = model.network();
  BoundaryConditions bc;
  if (model.body) {
    bc = transfer(loads, *model.body->mesh, model.embedding, network, model.springs.density, kinematics, factor);
  } else {
    if (!loads.empty()) throw InputError("loads: the springs of a file have no body (allowed: held, forces)");
    bc.fixed.assign(3 * static_cast<std::size_t>(network.nodes()), 0);
    bc.owner.assign(bc.fixed.size(), -1);
    bc.prescribed = bc.external = NodalVectors::Zero(network.nodes(), 3);
  }
  for (std::size_t h = 0; h < nodes.held.size(); ++h)
    for (int d = 0; d < 3; ++d) {
      const double u = nodes.displacement(static_cast<Eigen::Index>(h), d);
      if (std::isnan(u)) continue;
      const std::size_t unknown = 3 * static_cast<std::size_t>(nodes.held[h]) + static_cast<std::size_t>(d);
      bc.fixed[unknown] = 1;
      bc.owner[unknown] = static_cast<int>(loads.size());
      bc.prescribed(nodes.held[h], d) = factor * u;
    }
  for (const CarriedPoint& c : network.cells.carried)
    for (int d = 0; d < 3; ++d)
      if (bc.fixed[3 * static_cast<std::size_t>(c.point) + static_cast<std::size_t>(d)])
        throw InputError(fmt::format("held: node {} follows others (allowed: nodes with a mass)", c.point));
  if (nodes.forces.size() > 0) bc.external += factor * nodes.forces;
  hand_back(network.cells.carried, bc.external);
  if (model.parameters.hold_rigid_motions) hold_free_motions(network.X, bc, network.cells.carried);
  return bc;
}

AttachedMass mass_of(double kg, const py::object& at, const std::string& on, bool weighs) {
  if (!(kg > 0 && std::isfinite(kg))) throw InputError(fmt::format("mass: is {} (allowed: a number > 0 [kg])", kg));
  if (at.is_none() == on.empty()) throw InputError("Mass: needs a place (allowed: one of at and on)");
  AttachedMass mass{"mass", on, {}, kg, weighs};
  if (at.is_none()) return mass;
  const auto given = at.cast<Numbers>();
  if (given.ndim() == 1) {
    mass.at = {finite(vector_of(given, "at"), "at")};
  } else {
    const NodalVectors ends = finite(rows_of(given, "at", 2), "at");
    mass.at = {ends.row(0).transpose(), ends.row(1).transpose()};
  }
  return mass;
}

void bind_loads(py::module_& m) {
  py::class_<PrescribedDisplacement>(m, "Displacement", "A support: displacement (x, y, z) [m] of a patch; None: free.")
      .def(py::init([](const std::string& on, const std::array<std::optional<double>, 3>& displacement) {
             for (const auto& along : displacement)
               if (along) finite(*along, "displacement");
             return PrescribedDisplacement{on, displacement};
           }),
           "on"_a, "displacement"_a = std::array<std::optional<double>, 3>{0.0, 0.0, 0.0})
      .def_readonly("on", &PrescribedDisplacement::on, "name of the patch");
  py::class_<PrescribedRotation>(m, "Rotation",
                                 "A support: rotation of a patch by `angle` [rad] about an axis through `point` [m].")
      .def(py::init([](const std::string& on, const Numbers& point, const Numbers& axis, double angle) {
             const Vec3 direction = finite(vector_of(axis, "axis"), "axis");
             if (!(direction.norm() > 0)) throw InputError("axis: is zero (allowed: a direction)");
             return PrescribedRotation{on, finite(vector_of(point, "point"), "point"), direction.normalized(),
                                       finite(angle, "angle")};
           }),
           "on"_a, "point"_a, "axis"_a, "angle"_a)
      .def_readonly("on", &PrescribedRotation::on, "name of the patch");
  py::class_<PatchForce>(m, "Force", "A force [N] spread evenly over a patch.")
      .def(py::init([](const std::string& on, const Numbers& force) {
             return PatchForce{on, finite(vector_of(force, "force"), "force")};
           }),
           "on"_a, "force"_a)
      .def_readonly("on", &PatchForce::on, "name of the patch");
  py::class_<Traction>(m, "Traction", "Force per rest area of a patch [Pa], constant in direction.")
      .def(py::init([](const std::string& on, const Numbers& traction) {
             return Traction{on, finite(vector_of(traction, "traction"), "traction")};
           }),
           "on"_a, "traction"_a)
      .def_readonly("on", &Traction::on, "name of the patch");
  py::class_<Pressure>(m, "Pressure", "Pressure on a patch [Pa], along its normals at rest.")
      .def(py::init([](const std::string& on, double pressure) {
             return Pressure{on, finite(pressure, "pressure")};
           }),
           "on"_a, "pressure"_a)
      .def_readonly("on", &Pressure::on, "name of the patch");
  py::class_<Gravity>(m, "Gravity", "Acceleration of the whole body [m/s^2].")
      .def(py::init([](const Numbers& acceleration) {
             return Gravity{finite(vector_of(acceleration, "acceleration"), "acceleration")};
           }),
           "acceleration"_a);
  py::class_<PointForce>(m, "PointForce", "A force [N] at a point of the body at rest [m].")
      .def(py::init([](const Numbers& at, const Numbers& force) {
             return PointForce{finite(vector_of(at, "at"), "at"), finite(vector_of(force, "force"), "force")};
           }),
           "at"_a, "force"_a);
  py::class_<AttachedMass>(m, "Mass", R"(A mass that is no part of the body, for Model(masses=[...]).

at: a point of the body, or the two ends of a segment that it is spread along, 2 x 3 [m]; or on: a patch.  weighs=False:
Gravity does not act on it.)")
      .def(py::init(&mass_of), "mass"_a, "at"_a = py::none(), py::kw_only(), "on"_a = "", "weighs"_a = true)
      .def_readonly("mass", &AttachedMass::mass, "[kg]");
}

void bind_statics(py::module_& m, py::class_<BodyModel, std::shared_ptr<BodyModel>>& model) {
  bind_state(m);
  model.def("solve", &solve, "loads"_a = std::vector<BoundLoad>(), py::kw_only(), "held"_a = py::none(),
            "displacement"_a = py::none(), "forces"_a = py::none(), "large"_a = false,
            R"(Static equilibrium under loads on the body's patches, and of nodes.

held: numbers of nodes, or n flags; displacement: theirs, (x, y, z) or one row each [m], NaN: free, default 0; forces on all
nodes, n x 3 [N].  large=False: linearised at rest; True: Newton's method with load steps.
Raises InputError if a rigid motion is free, SolveError if there is no equilibrium.)");
}

}  // namespace springproof::python
