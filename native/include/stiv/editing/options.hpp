// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stiv/acceptance/storage.hpp"
#include "stiv/detection/detector.hpp"
#include "stiv/volumes/patch.hpp"

namespace stiv {

/// How an edit is solved. Every default is the one recommended.
struct EditOptions {
  double separation = 0;    ///< h that surfaces keep, world units; 0: 1e-4 of the diagonal of what may move
  double keep = 0.5;        ///< fraction of its distance that a pair keeps which starts nearer than h
  double smoothness = 0.1;  ///< damping of the metric: 0.1 smooth, 0.01 tight
  Eigen::VectorXd weights;  ///< (m) response of each control, 0 pins; empty: all 1
  ConstraintKind constraints = ConstraintKind::per_patch;
  BroadPhase broad_phase = BroadPhase::bvh;
  int max_sub_edits = 6;
  int max_rounds = 60;                ///< a sub-edit
  int accumulated_rounds = 12;        ///< rounds that keep the constraints of the rounds before
  double pull_limit = 0.04;           ///< a drag's pull toward its goal, in diagonals of what may move
  bool single_precision = true;       ///< controls are stored as float32; false: as they are
  std::vector<StorageFrame> storage;  ///< frames of stored controls; empty with single_precision: world frame for all
  double time_budget = 0;             ///< seconds an edit; 0: none
  int threads = 0;                    ///< 0: all
};

}  // namespace stiv
