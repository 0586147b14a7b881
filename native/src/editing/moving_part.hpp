// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

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
  /// region_areas of all vertices; those of the other part are computed once.
  Eigen::VectorXd region_areas(const Positions& q) const;

 private:
  /// Elements [first, end).
  struct Range {
    Index first = 0, end = 0;

    Index count() const { return end - first; }
    void include(Index element);
  };

  std::shared_ptr<const Surface> surface_;
  const Positions& obstacles_;
  Range rows_, triangles_;
  mutable Eigen::VectorXd areas_of_rest_;
};

}  // namespace stiv
