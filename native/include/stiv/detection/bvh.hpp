// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <vector>

#include "stiv/detection/bounds.hpp"
#include "stiv/execution.hpp"

namespace stiv {

/// A bounding-volume hierarchy over boxes, built once and refitted when they move.
class Bvh {
 public:
  /// Builds over the centres of the given boxes.
  explicit Bvh(const std::vector<Bounds>& boxes);

  /// New boxes, same number and order. `active[i]` (empty: all) tells whether primitive i can be part of a pair that
  /// matters; two subtrees without any active primitive are never compared.
  void refit(const std::vector<Bounds>& boxes, const std::vector<unsigned char>& active = {});

  Index size() const;

  /// Pairs (i of a, j of b) whose boxes overlap and of which at least one is active. Order depends on the trees alone.
  /// Several threads work; `pairs` come out the same for any number of them.
  static std::vector<std::pair<Index, Index>> overlapping_pairs(const Bvh& a, const Bvh& b, const Execution& execution);
  /// The same within one tree, each unordered pair once, i != j.
  static std::vector<std::pair<Index, Index>> overlapping_pairs(const Bvh& tree, const Execution& execution);

  /// Implementation detail, free to change: what the node layout is.
  struct Node;

 private:
  std::vector<Node> nodes_;
  std::vector<Index> order_;
};

}  // namespace stiv
