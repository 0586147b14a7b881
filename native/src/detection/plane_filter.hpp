// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>

#include "stiv/detection/event.hpp"

namespace stiv {

/// Eight pairs side by side, each seen from its first vertex: a quick answer for the many pairs that the plane of the
/// face (or of both edges) at the start of the step shows apart for the whole step.
class PlaneFilter {
 public:
  static constexpr std::size_t width = 8;

  /// Sets one of the pairs. Rows of `start` and `end` are positions, (N, 3).
  void set(std::size_t lane, const std::array<Index, 4>& vertices, const Positions& start, const Positions& end);

  /// 1 for each pair that keeps more than `separation`, by more than all rounding.
  std::array<int, width> apart(EventKind kind, double separation) const;

 private:
  using Lanes = std::array<double, width>;

  template <EventKind kind>
  std::array<int, width> apart(double separation) const;

  // Vertices 1 to 3 (the first is the origin), then x, y, z.
  std::array<std::array<Lanes, 3>, 3> start_{}, end_{};
};

}  // namespace stiv
