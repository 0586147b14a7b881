// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "acceptance/intersection/exact_intersection.hpp"

namespace stiv {

/// Sign of orientation_3d after an infinitesimal translation of one body by `perturbation` * (e, e^2, e^3),
/// perturbation 1 or -1. Bodies that touch then either cross or are apart, and all signs are consistent, since the
/// bodies are in general position. (mathematics.md, "Excluded pairs"; after Edelsbrunner, Mücke, Simulation of
/// simplicity, 1990)
struct PerturbedSign {
  int value = 0;          ///< 0 only if a triangle has no area or edges are parallel
  bool touching = false;  ///< the sign is 0 without the perturbation
};

/// orientation_3d(t0, t1, t2, p), the point perturbed.
PerturbedSign perturbed_side(const Triangle& t, const Vector3& p, int perturbation);

/// orientation_3d(e0, e1, f0, f1), the second edge perturbed.
PerturbedSign perturbed_turn(const Segment& e, const Segment& f, int perturbation);

/// The intersection of a segment with a triangle.
struct Piercing {
  int step = 0;                                       ///< 1 from the triangle's front to its back, else -1
  double at = 0;                                      ///< fraction of the segment
  Eigen::Vector2d weights = Eigen::Vector2d::Zero();  ///< of the triangle's second and third corner
};

/// The intersection of a perturbed segment with a triangle, if there is one. Its existence and `step` are exact; the
/// rest is rounded.
/// @param touching set to true if the perturbation decided
std::optional<Piercing> piercing(const Segment& segment, const Triangle& triangle, int perturbation, bool& touching);

}  // namespace stiv
