// SPDX-License-Identifier: GPL-3.0-or-later
#include "module.hpp"

namespace stiv::bindings {

void bind_editing(pybind11::module_&) {}

}  // namespace stiv::bindings
