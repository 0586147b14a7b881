// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/vector_target.hpp"

#include <pybind11/native_enum.h>

#include "module.hpp"

namespace py = pybind11;

namespace stiv::bindings {

void bind_vector_target(py::module_& module) {
  py::native_enum<VectorTarget>(module, "VectorTarget", "enum.Enum")
      .value("baseline", VectorTarget::baseline)
      .value("avx2", VectorTarget::avx2)
      .value("avx512", VectorTarget::avx512)
      .finalize();
  module.def("best_vector_target", &best_vector_target);
  module.def("vector_target", &vector_target);
  module.def("limit_vector_target", &limit_vector_target, py::arg("most"));
}

}  // namespace stiv::bindings
