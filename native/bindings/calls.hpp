// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <atomic>
#include <exception>
#include <string>

#include "stiv/editing/session.hpp"
#include "stiv/error.hpp"
#include "stiv/execution.hpp"

namespace stiv::bindings {

namespace py = pybind11;

using DoubleArray = py::array_t<double, py::array::c_style | py::array::forcecast>;

struct CancelToken {
  std::atomic<bool> cancelled{false};
};

inline Controls controls_from(const DoubleArray& array, const char* what) {
  if (array.ndim() != 2 || array.shape(1) != 3)
    throw InputError(std::string(what) + " must have shape (m, 3), not " +
                     py::cast<std::string>(py::str(array.attr("shape"))));
  return Eigen::Map<const Controls>(array.data(), array.shape(0), 3);
}

inline py::dict dict_of(const Counters& counters) {
  py::dict result;
  result["sub_edits"] = counters.sub_edits;
  result["rounds"] = counters.rounds;
  result["detections"] = counters.detections;
  result["candidate_pairs"] = counters.candidate_pairs;
  result["pairs_tested"] = counters.pairs_tested;
  result["events"] = counters.events;
  result["acceptance_tries"] = counters.acceptance_tries;
  result["infeasible"] = counters.infeasible;
  return result;
}

inline py::dict dict_of(const Timings& timings) {
  py::dict result;
  result["deformation"] = timings.deformation;
  result["detection"] = timings.detection;
  result["volumes"] = timings.volumes;
  result["response"] = timings.response;
  result["acceptance"] = timings.acceptance;
  result["total"] = timings.total;
  return result;
}

/// The result of an edit by the names of EditResult. Defined in editing.cpp.
py::dict dict_of(const EditResult& result);

/// Calls Python's progress function from the core. An exception in it, keyboard interrupts included, cancels the work
/// and is raised again after the core has returned.
class ProgressCall {
 public:
  ProgressCall(const py::object& function, Execution& execution) : function_(function), execution_(execution) {
    execution_.set_progress([this](const char* phase, double fraction) { report(phase, fraction); });
  }

  void rethrow() const {
    if (raised_) std::rethrow_exception(raised_);
  }

 private:
  void report(const char* phase, double fraction) {
    if (raised_) return;
    const py::gil_scoped_acquire lock;
    try {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      if (!function_.is_none()) function_(phase, fraction);
    } catch (const py::error_already_set&) {
      raised_ = std::current_exception();
      execution_.request_cancel();
    }
  }

  const py::object& function_;
  Execution& execution_;
  std::exception_ptr raised_;
};

}  // namespace stiv::bindings
