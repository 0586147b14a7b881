// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "stiv/detection/event.hpp"
#include "stiv/detection/proximity.hpp"
#include "stiv/execution.hpp"
#include "stiv/surface.hpp"

namespace stiv {

enum class BroadPhase {
  bvh,         ///< bounding-volume hierarchies, kept and refitted
  hash_grid,   ///< cells of equal size, found by hashing; made anew at each step
  brute_force  ///< all pairs: the oracle of the others
};

enum class NarrowPhase {
  conservative,  ///< advancement by separating planes: never late, never missed
  polynomial     ///< roots of cubics or of degree-six polynomials, 1/100 early, as the paper has it: misses some
};

struct DetectorOptions {
  BroadPhase broad_phase = BroadPhase::bvh;
  NarrowPhase narrow_phase = NarrowPhase::conservative;
};

/// Finds interference along linear steps of one surface; keeps its trees between calls. [P4.1]
/// Pairs that share a vertex, pairs of bodies that do not meet and pairs of which no vertex moves are left out.
/// Results do not depend on the number of threads, and not on the broad phase: a narrow phase reports no pair whose
/// bounds, padded by a little more than half of the separation, stay apart. (swept_vertices.cpp)
class Detector {
 public:
  Detector(std::shared_ptr<const Surface> surface, DetectorOptions options = {});
  ~Detector();
  Detector(Detector&&) noexcept;
  Detector& operator=(Detector&&) noexcept;

  /// All events of the step start -> end, (N, 3) each, sorted by kind and vertices.
  Events find(const PositionsView& start, const PositionsView& end, Proximity proximity, Execution& execution);

  /// The same, or nothing if the step brings more pairs near each other than can be looked at in bounded time and
  /// memory: then look at a shorter one. Whether it does depends on the step alone. Only trees refuse; they do so
  /// however short the step, where so much lies in one place at the start.
  std::optional<Events> find_if_manageable(const PositionsView& start, const PositionsView& end, Proximity proximity,
                                           Execution& execution);

  /// Vertices of the few pairs kept, ascending. Kept are those that the step of a whole search, or one that leads each
  /// vertex a part of its way, may bring within the separation: of all searches that were complete, and their steps
  /// manageable, less what `leave_kept` and `forget_kept` dropped. Depends on these steps alone.
  const std::vector<Index>& kept_vertices(const Execution& execution);

  /// The events of a step among the pairs kept, and no others: for rounds of an edit whose answers are looked at again
  /// anyway. Of the step only the rows of `kept_vertices` are given, (k, 3) each.
  /// @throws InputError if they are not so many, or not finite
  Events find_among_kept(const PositionsView& start, const PositionsView& end, Proximity proximity,
                         Execution& execution);

  /// Drops kept pairs that a step, given whole, does not bring close in the same sense: where another edit begins.
  void leave_kept(const PositionsView& start, const PositionsView& end, Proximity proximity,
                  const Execution& execution);

  /// Drops all of them.
  void forget_kept();

  /// The earliest time over all events, `never` when there is none. Cheaper than `find`: later pairs are cut short.
  double earliest_time(const PositionsView& start, const PositionsView& end, Proximity proximity, Execution& execution);

  std::optional<double> earliest_time_if_manageable(const PositionsView& start, const PositionsView& end,
                                                    Proximity proximity, Execution& execution);

  const Surface& surface() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace stiv
