// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <pybind11/pybind11.h>

namespace stiv::bindings {

void bind_job(pybind11::module_& module);
void bind_surface(pybind11::module_& module);
void bind_obstacle(pybind11::module_& module);
void bind_deformation(pybind11::module_& module);
void bind_detection(pybind11::module_& module);
void bind_acceptance(pybind11::module_& module);
void bind_editing(pybind11::module_& module);
void bind_repair(pybind11::module_& module);
void bind_points(pybind11::module_& module);
void bind_vector_target(pybind11::module_& module);

}  // namespace stiv::bindings
