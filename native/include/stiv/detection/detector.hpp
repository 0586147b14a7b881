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
  bvh,         ///< bounding-volume hierarchies, refitted from step to step
  hash_grid,   ///< uniform grid of hashed cells, built for each step
  brute_force  ///< all pairs: the oracle of the others
};

enum class NarrowPhase {
  conservative,  ///< advancement by separating planes: no contact is missed or late
  polynomial     ///< roots of polynomials, 1/100 early, as published: misses some contacts
};

class CandidateCache;
class PairSearch;

struct DetectorOptions {
  BroadPhase broad_phase = BroadPhase::bvh;
  NarrowPhase narrow_phase = NarrowPhase::conservative;
  /// Vertices from which one of several bodies may have its own frame in the broad phase; fewer pairs within a smaller
  /// one are not worth it. Events do not depend on it.
  Index large_body = 1 << 14;
};

/// Finds interference along linear steps of one surface, with trees that are cached between calls. [P4.1]
/// Skips pairs that share a vertex, pairs of bodies that are not tested, and pairs without a moving vertex.
/// Results depend neither on the number of threads nor on the broad phase: no narrow phase reports a pair whose bounds,
/// padded by a little more than half of the separation, stay apart. (swept_vertices.cpp)
class Detector {
 public:
  Detector(std::shared_ptr<const Surface> surface, DetectorOptions options = {});
  ~Detector();
  Detector(Detector&&) noexcept;
  Detector& operator=(Detector&&) noexcept;

  /// Builds the trees now that the first step from `start`, (N, 3), would build. Results do not depend on it.
  /// @param proximity of later steps; with any other, they take longer
  void prepare(const PositionsView& start, Proximity proximity, Execution& execution);

  /// All events of the step start -> end, (N, 3) each, sorted by kind and vertices.
  Events find(const PositionsView& start, const PositionsView& end, Proximity proximity, Execution& execution);

  /// The same, or nothing if the step has more close pairs than bounded time and memory allow, or has events while a
  /// large one of several bodies moves by many edges: then search a shorter step. The result depends only on the step.
  /// Only `BroadPhase::bvh` limits pairs. If too many primitives overlap at the start, every step exceeds that limit.
  std::optional<Events> find_within_pair_limit(const PositionsView& start, const PositionsView& end,
                                               Proximity proximity, Execution& execution);

  /// The earliest time of any event, `never` if there is none. Cheaper than `find`, which examines later pairs too.
  double earliest_time(const PositionsView& start, const PositionsView& end, Proximity proximity, Execution& execution);

  std::optional<double> earliest_time_within_pair_limit(const PositionsView& start, const PositionsView& end,
                                                        Proximity proximity, Execution& execution);

  const Surface& surface() const;

 private:
  friend class CandidateCache;
  std::unique_ptr<PairSearch> search_;
};

}  // namespace stiv
