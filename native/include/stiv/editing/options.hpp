// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stiv/acceptance/intersections.hpp"
#include "stiv/acceptance/storage.hpp"
#include "stiv/deformation/metric.hpp"
#include "stiv/detection/detector.hpp"
#include "stiv/response/resolver.hpp"
#include "stiv/volumes/patch.hpp"

namespace stiv {

/// What the volumes of a response measure.
enum class VolumeKind {
  relative,   ///< how far two sides approach each other, to a distance (stiv.hpp)
  published,  ///< how far each side moves by itself, as in the paper (published.hpp); no distance unless one is asked
              ///< for
  published_frozen  ///< the same with PublishedGradient::frozen
};

/// The separation of two bodies, or of a body from itself, where it is not that of the scene.
struct BodyPairSeparation {
  Index first = 0, second = 0;
  double separation = 0;
};

/// How an edit is solved. Every default is the one recommended.
struct EditOptions {
  double separation = 0;  ///< h that surfaces keep, world units; 0: 1e-4 of the diagonal of what may move
  std::vector<BodyPairSeparation> pair_separations;  ///< of bodies, instead of h
  /// In (0, 1). A pair of primitives nearer than h at the start of the session keeps this fraction of its distance,
  /// within a body and between bodies. Within a body, this bounds the compression of a mesh finer than h.
  double min_clearance_ratio = 0.5, min_clearance_ratio_between = 0.9;
  double smoothness = 0.1;  ///< damping of the metric: 0.1 smooth, 0.01 tight
  /// Response of each control, (m), or of each of its coordinates, (3 m): 0 pins. Empty: all 1. As in MetricOptions.
  Eigen::VectorXd weights;
  std::vector<Eigen::Matrix3d> weight_axes;  ///< (m) rotations: the three weights act along columns; empty: x, y, z
  /// Pairs of triangles that may intersect, at the start and later: their number that does never grows from one
  /// accepted state to the next, and no other pair ever intersects. What belongs to such pairs alone is not detected.
  /// Two closed bodies never have more volume in common than at the start of the session, and of an open body no more
  /// area, counted as it was at the start, is inside of a closed one.
  IndexPairs excluded;
  ConstraintKind constraints = ConstraintKind::per_patch;
  ConstraintSolver solver = ConstraintSolver::lcp;  ///< linear keeps no constraints from round to round
  MetricKind metric = MetricKind::energy;
  VolumeKind volumes = VolumeKind::relative;
  NarrowPhase narrow_phase = NarrowPhase::conservative;  ///< of the rounds; acceptance is always conservative and exact
  BroadPhase broad_phase = BroadPhase::bvh;
  int max_sub_edits = 6;
  int max_rounds = 60;                ///< a sub-edit
  int accumulated_rounds = 12;        ///< rounds that keep the constraints of the rounds before
  double pull_limit = 0.04;           ///< a drag's pull toward its goal, in diagonals of what may move; 0: none
  bool single_precision = true;       ///< controls are stored as float32; false: as they are
  std::vector<StorageFrame> storage;  ///< frames of stored controls; empty with single_precision: world frame for all
  double time_budget = 0;             ///< seconds an edit, but not less than one round; 0: none
  int threads = 0;                    ///< 0: all
};

}  // namespace stiv
