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
  EditOptions edit;                  ///< of the expansion: separation, storage, time budget (of the whole), threads
  std::vector<unsigned char> moves;  ///< (m) nonzero where a control may move; empty: all of deformable bodies
  double good_deviation = 0.01;      ///< a repair that deviates no more is taken at once; else others are tried as well
  double max_deviation = 0.05;       ///< a repair that deviates more is refused
};

enum class RepairStatus {
  already_free,  ///< nothing intersects
  repaired,      ///< the exact test finds nothing at the new positions
  refused,       ///< positions as they were; `refusal` says why
  cancelled,     ///< positions as they were
  budget         ///< the time budget ended before anything good was found; positions as they were
};

enum class RepairRefusal {
  none,
  coincident,  ///< triangles lie exactly on others: neither side is the inside of the other
  held,        ///< two that intersect have no vertex that may move
  not_freed,   ///< no contraction was without intersections
  too_far      ///< every repair found deviates by more than max_deviation
};

struct RepairResult {
  RepairStatus status = RepairStatus::already_free;
  RepairRefusal refusal = RepairRefusal::none;
  Controls positions;      ///< (m, 3); those given unless repaired
  StaticPairs pairs;       ///< what intersects at `positions`
  Index pairs_before = 0;  ///< number of pairs at the positions given
  Index fewest_pairs = 0;  ///< number of pairs that the best contraction left
  Index steps = 0;         ///< steps of contraction, of all tries
  double deviation = 0;    ///< root mean square distance of the best repaired surface from the one given, over what
                           ///< may move and in its diagonals; set when refused as too far as well
  std::string contracted;  ///< what was contracted: names of bodies, "shrunk components", "components" or "regions"
  Counters counters;
  Timings timings;
};

/// Removes intersections that a surface already has: contracts its cage until the exact test finds none, then expands
/// it back with interference. [P5.2, Figure 5] Tried in this order, until one comes near enough: each body that all
/// pairs have in common, closed ones first; all bodies that take part; their connected components shrunk until they are
/// apart, then the parts around what intersects within them; the components contracted one after the other; the parts
/// around what intersects. Success is claimed only where the exact test says so; nothing is made worse.
/// @param p (m, 3) controls
/// @throws InputError for shapes and options that do not fit
RepairResult repair(const CagedSurface& caged, const Controls& p, const RepairOptions& options, Execution& execution);

/// The same for a surface that is its own cage, at q, (N, 3).
inline RepairResult repair(const std::shared_ptr<const Surface>& surface, const Positions& q,
                           const RepairOptions& options, Execution& execution) {
  return repair(without_cage(surface), q, options, execution);
}

}  // namespace stiv
