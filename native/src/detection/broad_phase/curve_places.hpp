// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "detection/broad_phase/numbered_point.hpp"

namespace stiv {

/// The cube around points has 2^curve_bits cells on each side.
constexpr unsigned curve_bits = 10;
constexpr std::uint32_t curve_side = 1U << curve_bits;

/// The cell that a Hilbert curve reaches with step number `place`, and the index of a point in it.
struct CurveEntry {
  std::uint32_t place;
  std::uint32_t point;
};

/// Maps points to cells after the least coordinates are subtracted.
struct CellScale {
  std::array<float, 3> low;
  float scale;
};

/// Writes an entry for each point, in their order.
void find_places(std::span<const NumberedPoint> points, const CellScale& scale, CurveEntry* entries);

}  // namespace stiv
