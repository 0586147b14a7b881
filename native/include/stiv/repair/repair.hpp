// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "stiv/acceptance/intersections.hpp"
#include "stiv/editing/options.hpp"
#include "stiv/repair/contraction.hpp"

namespace stiv {

struct RepairOptions {
  ContractionOptions contraction;
  EditOptions edit;                  ///< of the expansion; its time budget is that of the whole repair
  std::vector<unsigned char> moves;  ///< (m) nonzero for controls that may move; empty: all of deformable bodies
  double good_deviation = 0.01;      ///< largest deviation at which no other strategy is tried
  double max_deviation = 0.05;       ///< repairs with a larger deviation are refused
};

enum class RepairStatus {
  already_free,  ///< the input has no intersections
  repaired,      ///< the exact test finds no intersections at the new positions
  refused,       ///< positions unchanged; `refusal` says why
  cancelled,     ///< positions unchanged
  budget         ///< positions unchanged: the time budget ended before a repair within max_deviation was found
};

enum class RepairRefusal {
  none,
  coincident,  ///< triangles coincide, so that no side is inside the other
  held,        ///< an intersecting pair has no vertex that may move
  not_freed,   ///< no contraction removed all intersections
  too_far      ///< every repair deviates by more than max_deviation
};

struct RepairResult {
  RepairStatus status = RepairStatus::already_free;
  RepairRefusal refusal = RepairRefusal::none;
  Controls positions;        ///< (m, 3); the input unless repaired
  bool out_of_time = false;  ///< the time budget ended the repair: a longer one may find another, or a closer one
  StaticPairs pairs;         ///< intersections at `positions`
  Index pairs_before = 0;    ///< number of intersecting pairs of the input
  Index fewest_pairs = 0;    ///< number of intersecting pairs after the best contraction
  Index steps = 0;           ///< steps of contraction, of all strategies
  double deviation = 0;    ///< root mean square distance of the best repaired surface from the input, over the vertices
                           ///< that may move, in diagonals of their bounding box; also set if the repair is refused
                           ///< because of it
  std::string contracted;  ///< the best strategy: name of a body, "all", "shrunk components", "components", "regions"
  Counters counters;
  Timings timings;
};

/// Removes intersections of a surface: contracts its cage until the exact test finds none, then expands it back with
/// interference. [P5.2, Figure 5] It tries these strategies until the deviation is small enough:
/// - each body that all pairs share, closed ones first; then all intersecting bodies;
/// - connected components shrunk until they are apart, then regions around the remaining pairs;
/// - connected components contracted in sequence;
/// - regions around the intersecting pairs.
/// A repair counts only if the exact test finds no intersections; otherwise positions stay unchanged.
/// @param p (m, 3) controls
/// @throws InputError for invalid sizes and options
RepairResult repair(const CagedSurface& caged, const Controls& p, const RepairOptions& options, Execution& execution);

/// The same for a surface that is its own cage, at q, (N, 3).
inline RepairResult repair(const std::shared_ptr<const Surface>& surface, const Positions& q,
                           const RepairOptions& options, Execution& execution) {
  return repair(without_cage(surface), q, options, execution);
}

}  // namespace stiv
