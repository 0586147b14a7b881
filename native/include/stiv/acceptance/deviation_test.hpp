// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>

#include "stiv/execution.hpp"
#include "stiv/surface.hpp"

namespace stiv {

/// The exact static test of surfaces that deviate from one without intersections by rounding, as the evaluation of an
/// application does. It examines the few pairs that may intersect then, without a search. Immutable: any thread may use
/// it, also while the IntersectionTest that listed the pairs tests other surfaces. (mathematics.md, "Surfaces within
/// rounding")
class DeviationTest {
 public:
  class Implementation;
  explicit DeviationTest(std::unique_ptr<const Implementation> implementation);
  ~DeviationTest();

  /// The largest deviation of a coordinate for which the pairs are complete.
  double reach() const;

  /// Is the surface free of intersections at q, (N, 3)? The answer is that of IntersectionTest::is_free. Nothing if a
  /// coordinate deviates by more than `reach`.
  std::optional<bool> is_free(const PositionsView& q, Execution& execution) const;

 private:
  std::unique_ptr<const Implementation> implementation_;
};

}  // namespace stiv
