// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "detection/broad_phase/numbered_point.hpp"

namespace stiv {

/// Sorts points along a Hilbert curve through their bounding cube, so that neighbors in the order are close together in
/// space. Linear in the number of points, where median splits take its logarithm. Depends only on the points and their
/// previous order.
void sort_along_curve(std::span<NumberedPoint> points);

}  // namespace stiv
