// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "detection/broad_phase/candidates.hpp"

namespace stiv {

/// Pairs of each kind.
using ClosePairs = std::array<std::vector<Candidate>, 2>;

/// Pairs of each kind that steps brought close, see append_close: few of all that a search looks at. What is kept
/// depends on those steps alone, not on the broad phase that found the pairs.
class KeptPairs {
 public:
  /// In ascending order.
  const std::vector<Candidate>& of(EventKind kind) const { return pairs_[static_cast<std::size_t>(kind)]; }

  /// Of all pairs, ascending.
  const std::vector<Index>& vertices() const { return vertices_; }

  /// Adds pairs, each given once and in any order; those that are kept already stay as they are.
  /// @throws Interrupted with nothing changed, as the other
  void add(const Surface& surface, ClosePairs pairs, const Execution& execution);

  /// The same of those of them that a step may bring close, and leaves only such of those kept before. `motion` is that
  /// of Step.
  void add_and_leave_close(const Surface& surface, const ClosePairs& pairs, const VertexSteps& vertices,
                           const Vector3& motion, double separation, const Execution& execution);

 private:
  void take(const Surface& surface, ClosePairs pairs);

  ClosePairs pairs_;
  std::vector<Index> vertices_;
};

}  // namespace stiv
