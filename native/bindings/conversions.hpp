// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <pybind11/pybind11.h>

#include <optional>

#include "stiv/acceptance/intersections.hpp"
#include "stiv/acceptance/least_distance.hpp"
#include "stiv/detection/event.hpp"

namespace stiv::bindings {

/// (K, 2)
Edges as_rows(const IndexPairs& pairs);

/// (distance, triangles, points), or None.
pybind11::object tuple_of(const std::optional<NearestTriangles>& nearest);

/// Events as arrays, in the order of the fields of the Python class: kind (K,) uint8, vertices (K, 4) int32, time (K,),
/// weights (K, 4), normal (K, 3), start_distance (K,).
pybind11::tuple arrays_of(const Events& events);

}  // namespace stiv::bindings
