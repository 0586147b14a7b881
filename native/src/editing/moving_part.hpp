// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "stiv/execution.hpp"
#include "stiv/surface.hpp"

namespace stiv {

/// The part of a surface that may move: from the first to the last element of bodies that are not fixed. Two states of
/// a session differ nowhere else. In large scenes it is small. Positions are given without those of obstacles.
class MovingPart {
 public:
  /// @param obstacles positions of the last vertices, (k, 3), which must outlive this
  MovingPart(std::shared_ptr<const Surface> surface, const Positions& obstacles);

  /// 1/2 |a - b|^2. (mathematics.md, Eq. 4)
  double energy(const Positions& a, const Positions& b) const;
  double longest_displacement(const Positions& from, const Positions& to) const;
  /// region_areas of all vertices, until the next call; those of the other part are computed once.
  const Eigen::VectorXd& region_areas(const Positions& q, const Execution& execution) const;

 private:
  /// Elements [first, end).
  struct Range {
    Index first = 0, end = 0;

    Index count() const { return end - first; }
    /// Elements come in ascending order.
    void include(Index element);
    /// In any order.
    void cover(Index element);
  };

  Index count_of_triangles(Index vertices) const;
  void compute_rest(const Positions& q, const Execution& execution) const;

  std::shared_ptr<const Surface> surface_;
  const Positions& obstacles_;
  Range rows_, triangles_;
  Range corners_;  ///< of those triangles
  mutable Eigen::VectorXd areas_of_rest_, areas_;
  mutable bool rest_is_complete_ = false;  ///< no vertex outside of `corners_` lacks an area
};

}  // namespace stiv
