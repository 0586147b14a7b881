// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stiv/acceptance/deviation_test.hpp"

#include <memory>

#include "acceptance/intersection/near_pairs.hpp"
#include "acceptance/intersection/stars.hpp"

namespace stiv {

class DeviationTest::Implementation {
 public:
  /// @param accepted positions without intersections
  /// @param near complete for these positions; neither changes
  Implementation(std::shared_ptr<const Surface> surface, std::shared_ptr<const Stars> stars,
                 std::shared_ptr<const Positions> accepted, std::shared_ptr<const NearPairs> near);

  double reach() const { return near_->reach; }
  std::optional<bool> is_free(const PositionsView& q, const Execution& execution) const;

 private:
  bool is_within_reach(const PositionsView& q) const;
  bool are_stars_free(const PositionsView& q, const PackedPoints& points, const Execution& execution) const;
  bool is_star_free(const PositionsView& q, Index vertex) const;
  bool are_pairs_free(const PositionsView& q, const PackedPoints& points, const Execution& execution) const;

  std::shared_ptr<const Surface> surface_;
  std::shared_ptr<const Stars> stars_;
  std::shared_ptr<const Positions> accepted_;
  std::shared_ptr<const NearPairs> near_;
};

}  // namespace stiv
