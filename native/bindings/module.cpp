// SPDX-License-Identifier: GPL-3.0-or-later
#include "module.hpp"

#include <pybind11/eigen.h>

#include "stiv/error.hpp"

namespace py = pybind11;

namespace {

// Never freed: the translators may run for as long as the interpreter does.
PyObject* input_error = nullptr;
PyObject* infeasible_error = nullptr;
PyObject* start_intersects_error = nullptr;
PyObject* cancelled_error = nullptr;

PyObject* new_exception(py::module_& module, const char* name, PyObject* base, const char* documentation) {
  const std::string qualified = std::string("stiv.") + name;
  PyObject* type = PyErr_NewExceptionWithDoc(qualified.c_str(), documentation, base, nullptr);
  if (type == nullptr) throw py::error_already_set();
  module.add_object(name, py::reinterpret_borrow<py::object>(type));
  return type;
}

void raise_start_intersects(const stiv::StartIntersectsError& error) {
  stiv::Edges pairs(static_cast<stiv::Index>(error.pairs.size()), 2);
  for (std::size_t k = 0; k < error.pairs.size(); ++k)
    pairs.row(static_cast<stiv::Index>(k)) << error.pairs[k].first, error.pairs[k].second;
  py::object exception = py::reinterpret_borrow<py::object>(start_intersects_error)(error.what());
  exception.attr("pairs") = pairs;
  PyErr_SetObject(start_intersects_error, exception.ptr());
}

void register_exceptions(py::module_& module) {
  input_error = new_exception(module, "InputError", PyExc_ValueError,
                              "Invalid input: the message names object and element. Nothing was changed.");
  infeasible_error = new_exception(module, "InfeasibleError", input_error,
                                   "A deformation has no surface at these controls. Nothing was changed.");
  start_intersects_error = new_exception(module, "StartIntersectsError", input_error,
                                         "The start intersects itself; `pairs`, (K, 2) int32, lists the triangles.");
  cancelled_error = new_exception(module, "CancelledError", PyExc_RuntimeError,
                                  "The work was cancelled before it had a result. Nothing was changed.");
  py::register_local_exception_translator(
      [](std::exception_ptr pointer) {  // NOLINT(performance-unnecessary-value-param)
        try {
          if (pointer) std::rethrow_exception(pointer);
        } catch (const stiv::StartIntersectsError& error) {
          raise_start_intersects(error);
        } catch (const stiv::InfeasibleError& error) {
          PyErr_SetString(infeasible_error, error.what());
        } catch (const stiv::InputError& error) {
          PyErr_SetString(input_error, error.what());
        } catch (const stiv::Interrupted& error) {
          PyErr_SetString(cancelled_error, error.what());
        }
      });
}

}  // namespace

PYBIND11_MODULE(_native, module) {
  module.doc() = "The native core. Use the package `stiv`, which documents it.";
  register_exceptions(module);
  stiv::bindings::bind_vector_target(module);
  stiv::bindings::bind_job(module);
  stiv::bindings::bind_surface(module);
  stiv::bindings::bind_obstacle(module);
  stiv::bindings::bind_deformation(module);
  stiv::bindings::bind_detection(module);
  stiv::bindings::bind_acceptance(module);
  stiv::bindings::bind_editing(module);
  stiv::bindings::bind_repair(module);
  stiv::bindings::bind_points(module);
}
