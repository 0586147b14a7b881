// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>

#include "stiv/types.hpp"

namespace stiv {

/// The range of nonzero coordinates, in magnitude, in which all signs and error bounds hold: no product of the exact
/// predicates underflows, and Veltkamp's splitting (which overflows above 2^996) stays below 2^800.
constexpr double least_coordinate = 1e-70;
constexpr double greatest_coordinate = 1e70;

inline bool is_valid_coordinate(double x) {
  const double magnitude = std::abs(x);
  return (magnitude >= least_coordinate && magnitude <= greatest_coordinate) || x == 0;
}

/// What is wrong with a coordinate and how to correct it, or null.
inline const char* coordinate_fault(double x) {
  if (is_valid_coordinate(x)) return nullptr;
  if (!std::isfinite(x)) return "coordinate is not finite";
  return std::abs(x) < 1 ? "coordinate is below 1e-70; set it to 0 or scale up"
                         : "coordinate is above 1e70; scale the object down";
}

/// Sets computed coordinates below the range to 0. Weights of distant controls cause them.
inline void flush_below_range(PositionRows q) {
  double* const numbers = q.data();
  for (Eigen::Index k = 0; k < q.size(); ++k) numbers[k] = std::abs(numbers[k]) < least_coordinate ? 0.0 : numbers[k];
}

}  // namespace stiv
