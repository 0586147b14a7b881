// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stiv/surface.hpp"

namespace stiv {

/// Displacements, in a step, of the frames in which boxes and hulls are computed. Any frame is valid. One that moves
/// along makes the boxes of a common motion small; one at rest keeps the boxes of vertices at rest unchanged.
struct FrameMotions {
  Vector3 common = Vector3::Zero();  ///< of pairs of bodies, and of bodies without a frame of their own
  std::vector<Vector3> of_bodies;    ///< empty: no body has a frame of its own
  bool go_far = false;               ///< one of these bodies moves by many edges

  bool has_own_frames() const { return !of_bodies.empty(); }
  const Vector3& of_body(Index body) const { return of_bodies.empty() ? common : of_bodies[body]; }
  const Vector3& of_pair(Index a, Index b) const { return a == b ? of_body(a) : common; }

  bool operator==(const FrameMotions&) const = default;
};

/// The mean displacement of a step if the displacements relative to it are much smaller, else zero. The mean of about a
/// thousand evenly picked vertices is enough. Depends only on the step, to the last bit. Zero without vertices.
Vector3 common_motion(const PositionsView& start, const PositionsView& end);

/// Chooses the frames of steps of a surface. Depends only on the step, to the last bit.
class FrameChooser {
 public:
  /// One of several bodies with at least `large_body` vertices may get a frame of its own if it is tested against
  /// itself.
  FrameChooser(const Surface& surface, Index large_body);

  /// The frame of a body moves with its own mean displacement if that leaves much less than the common motion does, and
  /// differs from it by several edges. A frame of its own makes pairs within the body fewer, but others more.
  FrameMotions choose(const PositionsView& start, const PositionsView& end) const;

 private:
  /// A body that may have its own frame, evenly picked vertices of it, and a neighbor of each.
  struct Sample {
    Index body;
    std::vector<Index> vertices, neighbours;
  };

  /// Mean square of the length of the edges.
  static double edge_square(const Sample& sample, const PositionsView& start);

  std::size_t body_count_;
  std::vector<Sample> samples_;
};

}  // namespace stiv
