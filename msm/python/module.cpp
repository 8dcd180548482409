// Python: the module, its errors, and arrays.
#include <fmt/format.h>

#include <exception>
#include <stdexcept>
#include <system_error>

#include "msm/python/bindings.h"

namespace springproof::python {

py::array indices(const std::vector<int>& numbers) {
  return py::array(py::dtype::of<int>(), {py::ssize_t(numbers.size())}, {}, numbers.data());
}

namespace {

std::string shape_of(const Numbers& values) { return py::str(values.attr("shape")).cast<std::string>(); }

}  // namespace

NodalVectors rows_of(const Numbers& values, const char* name, Eigen::Index rows) {
  if (values.ndim() != 2 || values.shape(1) != 3 || (rows >= 0 && values.shape(0) != rows))
    throw InputError(fmt::format("{}: has shape {} (allowed: ({}, 3))", name, shape_of(values),
                                 rows >= 0 ? std::to_string(rows) : "n"));
  return Eigen::Map<const NodalVectors>(values.data(), values.shape(0), 3);
}

Vec3 vector_of(const Numbers& values, const char* name) {
  if (values.ndim() != 1 || values.shape(0) != 3)
    throw InputError(fmt::format("{}: has shape {} (allowed: three numbers)", name, shape_of(values)));
  const Vec3 v(values.at(0), values.at(1), values.at(2));
  return v;
}

}  // namespace springproof::python

PYBIND11_MODULE(_springproof, m) {
  using namespace springproof;
  m.doc() = "Mass-spring models of elastic solids: bindings of the library msm.";
  static const pybind11::handle input_error =
      pybind11::register_exception<InputError>(m, "InputError", PyExc_ValueError).inc_ref();
  input_error.doc() = "An input that cannot be used: the place, the value, what is allowed.";
  pybind11::register_exception<python::SolveError>(m, "SolveError", PyExc_RuntimeError).doc() =
      "There is no equilibrium, or a motion diverges.";
  pybind11::register_local_exception_translator([](std::exception_ptr thrown) {
    try {
      std::rethrow_exception(std::move(thrown));
    } catch (const std::invalid_argument& e) {  // of the library, where no place in a file is known
      PyErr_SetString(input_error.ptr(), e.what());
    } catch (const std::system_error& e) {  // of a file; Python makes FileNotFoundError of 2
      PyErr_SetObject(PyExc_OSError, pybind11::make_tuple(e.code().value(), e.what()).ptr());
    }
  });
  python::bind_bodies(m);
  python::bind_loads(m);
  python::bind_models(m);
  python::bind_cases(m);
}
