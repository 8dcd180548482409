// What the sources of the Python module share: its objects, arrays without copies, interruption.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "meshes/locate/locate.h"
#include "meshes/voxels/cut_cells.h"
#include "msm/exchange/springs_file.h"
#include "msm/models.h"
#include "msm/statics/equilibrium.h"
#include "problem/region.h"
#include "problem/system/progress.h"

namespace springproof::python {

namespace py = pybind11;

/// The cubes that models are made of and, unless it is a block, the body that they were cut out of.
struct SolidBody {
  std::shared_ptr<const Mesh> mesh;
  std::shared_ptr<const Region> region;    ///< null: the mesh is the body
  std::shared_ptr<const CutBody> cut;      ///< null: the mesh is the body
  std::shared_ptr<const Mesh> tetrahedra;  ///< the true body; null: the mesh is the body
  std::vector<std::string> notes;
  std::vector<MaterialRegion> regions = {};
};

/// A model in a body, or the springs of a file, which have none.
struct BodyModel {
  SpringsFile springs;  ///< the model itself, density, material, patches and, of a file, the surface
  ModelParameters parameters;
  Embedding embedding;                    ///< in the body's mesh
  std::shared_ptr<const SolidBody> body;  ///< null: none
  Eigen::VectorXd mass;                   ///< of the nodes [kg]
  std::vector<AttachedMass> masses = {};  ///< beside the body's own; their inertia is in the network

  const MassSpringModel& model() const { return springs.model; }
  const Network& network() const { return springs.model.network; }
};
using ModelPointer = std::shared_ptr<const BodyModel>;

/// There is no equilibrium, or a motion diverges: springproof.SolveError.
struct SolveError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Arrays.  A view keeps `owner` alive and cannot be written to.

inline py::array read_only(py::array a) {
  py::detail::array_proxy(a.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return a;
}
template <class T>
py::array view(const T* data, std::vector<py::ssize_t> shape, const py::object& owner) {
  return read_only(py::array(py::dtype::of<T>(), std::move(shape), {}, data, owner));
}
inline py::array view(const NodalVectors& v, const py::object& owner) { return view(v.data(), {v.rows(), 3}, owner); }
template <std::size_t n>
py::array view(const std::vector<std::array<int, n>>& rows, const py::object& owner) {
  return view(reinterpret_cast<const int*>(rows.data()), {py::ssize_t(rows.size()), py::ssize_t(n)}, owner);
}
/// An array that owns what it is made of.
inline py::array moved(NodalVectors v) {
  auto* kept = new NodalVectors(std::move(v));
  const py::capsule owner(kept, [](void* p) { delete static_cast<NodalVectors*>(p); });
  return py::array(py::dtype::of<double>(), {kept->rows(), Eigen::Index(3)}, {}, kept->data(), owner);
}
py::array indices(const std::vector<int>& numbers);

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// The rows of an n x 3 array [rows = -1: any number].
/// @throws InputError naming the array, its shape and the shape it must have.
NodalVectors rows_of(const Numbers& values, const char* name, Eigen::Index rows = -1);
/// Three numbers.
Vec3 vector_of(const Numbers& values, const char* name);
/// The same numbers.
/// @throws InputError naming the argument if one is infinite or NaN.
template <class Value>
Value finite(Value value, const char* name) {
  if constexpr (std::is_arithmetic_v<Value>) {
    if (std::isfinite(value)) return value;
  } else {
    if (value.allFinite()) return value;
  }
  throw InputError(std::string(name) + ": a number is not finite (allowed: finite numbers)");
}

/// Raises KeyboardInterrupt after Ctrl-C; without the GIL.
inline void check_interruption() {
  const py::gil_scoped_acquire gil;
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}
/// Without the GIL; Ctrl-C is heard wherever the library reports its progress.
template <class F>
auto long_call(const F& work) {
  const py::gil_scoped_release released;
  const progress::Listening listening([](const std::string&, const std::string&) { check_interruption(); });
  return work();
}

/// The loads that Python has.
using BoundLoad =
    std::variant<PrescribedDisplacement, PrescribedRotation, Traction, Pressure, PatchForce, Gravity, PointForce>;
/// With the weight of the model's attached masses.
std::vector<Load> loads_of(const BodyModel& model, const std::vector<BoundLoad>& given);

/// Loads and supports of a model: those on the body's patches, nodes held, forces on nodes.
struct NodeConditions {
  std::vector<int> held;
  NodalVectors displacement;  ///< of the held nodes [m]; NaN: free
  NodalVectors forces;        ///< n x 3 [N]; empty: none
};
NodeConditions node_conditions(const BodyModel& model, const py::object& held, const py::object& displacement,
                               const py::object& forces);
BoundaryConditions conditions_of(const BodyModel& model, const std::vector<Load>& loads, const NodeConditions& nodes,
                                 Kinematics kinematics, double factor);

/// Options of a model as of a case file: numbers, true or false, names.
std::map<std::string, std::variant<bool, double, std::string>> options_of(const py::dict& given);

void bind_bodies(py::module_& m);
void bind_cases(py::module_& m);
void bind_loads(py::module_& m);
void bind_models(py::module_& m);
void bind_statics(py::module_& m, py::class_<BodyModel, std::shared_ptr<BodyModel>>& model);
void bind_motion(py::module_& m, py::class_<BodyModel, std::shared_ptr<BodyModel>>& model);

}  // namespace springproof::python
