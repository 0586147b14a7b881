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

class CandidateCache;
class PairSearch;

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

  /// The same, or nothing if the step brings more pairs near each other than bounded time and memory allow: then search
  /// a shorter step. The answer depends on the step alone. Only trees have a limit; where too many primitives lie in
  /// one place at the start, they refuse any step.
  std::optional<Events> find_within_pair_limit(const PositionsView& start, const PositionsView& end,
                                               Proximity proximity, Execution& execution);

  /// The earliest time over all events, `never` when there is none. Cheaper than `find`: later pairs are cut short.
  double earliest_time(const PositionsView& start, const PositionsView& end, Proximity proximity, Execution& execution);

  std::optional<double> earliest_time_within_pair_limit(const PositionsView& start, const PositionsView& end,
                                                        Proximity proximity, Execution& execution);

  const Surface& surface() const;

 private:
  friend class CandidateCache;
  std::unique_ptr<PairSearch> search_;
};

}  // namespace stiv
