// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <pybind11/pybind11.h>

#include <optional>

#include "stiv/acceptance/least_distance.hpp"

namespace stiv::bindings {

/// (distance, triangles, points), or None.
pybind11::object tuple_of(const std::optional<NearestTriangles>& nearest);

}  // namespace stiv::bindings
