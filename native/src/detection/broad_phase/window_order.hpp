// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>

#include "detection/broad_phase/numbered_point.hpp"

namespace stiv {

constexpr std::size_t window_capacity = 1024;

/// The first part of a split: the largest power of two times `run` that is less than `count`, so parts of all sizes end
/// where nodes of a tree end.
constexpr std::size_t size_of_first_part(std::size_t count, std::size_t run) {
  std::size_t half = run;
  while (2 * half < count) half *= 2;
  return half;
}

/// Splits up to `window_capacity` points at a median along the longest axis of their box, and then both parts, until
/// parts have at most `run` points. The same for all vector targets.
void order_window(std::span<NumberedPoint> points, std::size_t run);

}  // namespace stiv
