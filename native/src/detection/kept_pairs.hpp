// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "detection/candidates.hpp"

namespace stiv {

/// Pairs of each kind that steps brought close, see append_close: few of all that a search looks at. What is kept
/// depends on those steps alone, not on the broad phase that found the pairs.
class KeptPairs {
 public:
  /// In ascending order.
  const std::vector<Candidate>& of(EventKind kind) const { return pairs_[static_cast<std::size_t>(kind)]; }

  /// Adds pairs, each given once and in any order; those that are kept already stay as they are.
  void add(EventKind kind, std::vector<Candidate> pairs);

  /// Leaves those that a step may bring close. `motion` is that of Step.
  void leave_close(const Surface& surface, const VertexSteps& vertices, const Vector3& motion, double separation);

 private:
  std::array<std::vector<Candidate>, 2> pairs_;
};

}  // namespace stiv
