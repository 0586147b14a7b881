// SPDX-License-Identifier: GPL-3.0-or-later
#include "job.hpp"

#include "module.hpp"

namespace stiv::bindings {

namespace {

/// Waits for the work without Python's lock.
struct UnlockedDelete {
  void operator()(NativeJob* job) const {
    const py::gil_scoped_release unlocked;
    delete job;
  }
};

/// The calls of the work take Python's lock themselves.
py::tuple poll(const NativeJob& job) {
  const JobProgress progress = [&] {
    const py::gil_scoped_release unlocked;
    return job.poll();
  }();
  return py::make_tuple(progress.phase, progress.fraction, progress.done);
}

py::object result_of(const NativeJob& job) {
  const Translation& translate = [&]() -> const Translation& {
    const py::gil_scoped_release unlocked;
    return job.result();
  }();
  return translate();
}

}  // namespace

void bind_job(py::module_& module) {
  py::class_<NativeJob, std::unique_ptr<NativeJob, UnlockedDelete>>(module, "Job")
      .def("poll", &poll)
      .def("cancel", &NativeJob::cancel, py::call_guard<py::gil_scoped_release>())
      .def("wait_for", &NativeJob::wait_for, py::arg("seconds"), py::call_guard<py::gil_scoped_release>())
      .def("result", &result_of);
}

}  // namespace stiv::bindings
