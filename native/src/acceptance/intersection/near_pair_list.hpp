// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "acceptance/intersection/near_pairs.hpp"
#include "acceptance/intersection/stars.hpp"
#include "stiv/acceptance/deviation_test.hpp"
#include "stiv/surface.hpp"

namespace stiv {

/// Keeps the near pairs of the last surface without intersections, from test to test. Pairs at rest stay listed.
class NearPairList {
 public:
  NearPairList(std::shared_ptr<const Surface> surface, std::shared_ptr<const Stars> stars)
      : surface_(std::move(surface)), stars_(std::move(stars)) {}
  NearPairList(const NearPairList&) = delete;
  NearPairList& operator=(const NearPairList&) = delete;

  /// Begins a test.
  /// @param moved as in IntersectionTest::is_free
  /// @param least of the reach
  /// @return the vertices whose pairs have to be searched, as `moved`: those of `moved`, and more if the list needs
  /// them
  std::vector<unsigned char> begin(const PositionsView& q, const std::vector<unsigned char>& moved,
                                   const Execution& execution, double least = 0);

  /// Of the pairs to list, since `begin`.
  double reach() const { return reach_; }
  /// The margin of boxes that overlap wherever two primitives may meet within the reach.
  double margin() const { return (1 + 0x1p-30) * reach_; }

  /// Pairs with a searched vertex that a test found.
  struct Found {
    std::vector<CornerPair> triangles, loose;  ///< of triangles, and of loose elements with triangles
  };

  /// Ends a test of a surface without intersections.
  /// @param searched result of `begin`
  /// @param proofs of Stars, complete for stars with a searched vertex
  void accept(const PositionsView& q, const std::vector<unsigned char>& searched, const Found& found,
              const std::vector<unsigned char>& proofs, const Execution& execution);

  /// The test of surfaces near q; null unless q was accepted last.
  std::shared_ptr<const DeviationTest> test_near(const PositionsView& q) const;

 private:
  double reach_near(const PositionsView& q, const std::vector<unsigned char>& moved, const Execution& execution) const;
  void leave_to_test();
  bool is_in_star(const CornerPair& pair) const;

  std::shared_ptr<const Surface> surface_;
  std::shared_ptr<const Stars> stars_;
  double reach_ = 0;
  std::shared_ptr<Positions> accepted_ = std::make_shared<Positions>();
  std::shared_ptr<NearPairs> near_ = std::make_shared<NearPairs>();  ///< of `accepted_`
  bool is_complete_ = false;  ///< false before the first surface, and after an interruption of `accept`
  mutable std::shared_ptr<const DeviationTest> test_;  ///< shares both, made when first wanted
};

}  // namespace stiv
