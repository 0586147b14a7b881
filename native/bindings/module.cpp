// SPDX-License-Identifier: GPL-3.0-or-later
#include "module.hpp"

#include "stiv/error.hpp"

PYBIND11_MODULE(_native, module) {
  module.doc() = "Native core of stiv; use the package stiv, which documents it.";
  stiv::bindings::bind_surface(module);
  stiv::bindings::bind_deformation(module);
  stiv::bindings::bind_detection(module);
  stiv::bindings::bind_acceptance(module);
  stiv::bindings::bind_editing(module);
}
