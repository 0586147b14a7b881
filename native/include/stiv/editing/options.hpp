// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <utility>
#include <vector>

#include "stiv/acceptance/intersections.hpp"
#include "stiv/acceptance/storage.hpp"
#include "stiv/deformation/metric.hpp"
#include "stiv/detection/detector.hpp"
#include "stiv/response/resolver.hpp"
#include "stiv/volumes/patch.hpp"

namespace stiv {

/// How interference volumes are defined.
enum class VolumeKind {
  relative,         ///< by the approach of both sides, up to the clearance (stiv.hpp)
  published,        ///< by each side's own motion, as in the paper (published.hpp); without a separation by default
  published_frozen  ///< the same with PublishedGradient::frozen
};

/// The separation of two bodies, or of a body from itself, instead of that of the scene.
struct BodyPairSeparation {
  Index first = 0, second = 0;
  double separation = 0;
};

/// How an edit is solved. The defaults are recommended.
struct EditOptions {
  double separation = 0;  ///< h, the minimum distance, world units; 0: 1e-4 of the diagonal of the moving vertices
  std::vector<BodyPairSeparation> pair_separations;  ///< of bodies, instead of h
  /// In (0, 1). A pair of primitives nearer than h at the start of the session keeps this fraction of its distance,
  /// within a body and between bodies. Within a body, this bounds the compression of a mesh finer than h.
  double min_clearance_ratio = 0.5, min_clearance_ratio_between = 0.9;
  double smoothness = 0.1;  ///< damping of the metric: 0.1 spreads the response, 0.01 follows the goal closer
  /// Edits and settling end at the lowest energy within reach, to 1e-4, instead of a smooth state. Takes about
  /// twice as long. (mathematics.md, "Tight edits")
  bool tight = false;
  /// Response of each control, (m), or of each of its coordinates, (3 m): 0 pins. Empty: all 1. As in MetricOptions.
  Eigen::VectorXd weights;
  std::vector<Eigen::Matrix3d> weight_axes;  ///< (m) rotations: the three weights act along columns; empty: x, y, z
  /// Pairs of triangles that may intersect, with others that touch (EditSession::excluded). No other pair ever does,
  /// and the number of these that do, deeper than rounding, never grows. Events that belong only to these pairs are
  /// ignored. Parts of a body that only touch never intersect deeper than rounding. The common volume of two closed
  /// bodies, and the area of an open body inside a closed one, never exceed those of the start. (mathematics.md,
  /// "Excluded pairs")
  IndexPairs excluded;
  bool parts_may_cut = false;  ///< excluded pairs of parts that only touch have no limit, such as those at open seams
  /// Pairs of bodies that may overlap, but no more than at the start: they can part in any direction. While a pair
  /// overlaps, it has no events. Once it is apart, it is guarded like any other. (mathematics.md, "Overlapping bodies")
  std::vector<std::pair<Index, Index>> overlapping;
  /// Two of these bodies that only touch at the start may slide, part and touch, but never intersect deeper than
  /// rounding. One of them must be closed. Without this, rounding decides whether they start at all, and how far they
  /// move. (mathematics.md, "Excluded pairs")
  std::vector<Index> touching;
  ConstraintKind constraints = ConstraintKind::per_patch;
  ConstraintSolver solver = ConstraintSolver::lcp;  ///< linear does not accumulate constraints
  MetricKind metric = MetricKind::energy;
  VolumeKind volumes = VolumeKind::relative;
  NarrowPhase narrow_phase = NarrowPhase::conservative;  ///< of the rounds; acceptance is always conservative and exact
  BroadPhase broad_phase = BroadPhase::bvh;
  int max_sub_edits = 6;        ///< toward a goal or sub-goal; 1: one in all, without sub-goals
  int max_rounds = 60;          ///< in a sub-edit
  int accumulated_rounds = 12;  ///< rounds that accumulate constraints
  double pull_limit = 0.04;  ///< longest pull of a drag toward its goal, in diagonals of the moving vertices; 0: none
  bool single_precision = true;       ///< controls are stored as float32; false: as doubles
  std::vector<StorageFrame> storage;  ///< empty with single_precision: the world frame for all
  double time_budget = 0;             ///< seconds for each edit, at least one round; 0: no limit
  int threads = 0;                    ///< 0: one for each processor
};

}  // namespace stiv
