// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "stiv/editing/session.hpp"

namespace stiv {

/// A session behind EditSession, with the same members.
class SessionImplementation {
 public:
  virtual ~SessionImplementation() = default;

  virtual EditResult edit(const Controls& goal, Execution& execution) = 0;
  virtual EditResult drag(const Controls& goal, Execution& execution, std::optional<double> hand_over) = 0;
  virtual EditResult settle(Execution& execution) = 0;
  virtual EditResult confirm(Execution& execution) = 0;
  virtual void restore(const Controls& controls, const Controls& goal) = 0;
  /// As restore, for controls whose surface is known to be free of intersections: it is not tested again. For sessions
  /// without excluded pairs and bodies that may overlap.
  virtual void restore_free(const Controls& controls, const Controls& goal) { restore(controls, goal); }
  virtual void set_weights(Eigen::VectorXd weights, std::vector<Eigen::Matrix3d> weight_axes) = 0;
  virtual void end_drag() {}
  virtual bool is_step_free(const PositionsView& start, const PositionsView& end, Execution& execution) = 0;
  virtual std::shared_ptr<const DeviationTest> deviation_test() const = 0;
  virtual std::optional<NearestTriangles> least_distance(DistancePairs pairs) = 0;

  virtual const Controls& controls() const = 0;
  virtual const Positions& surface() const = 0;
  virtual double separation() const = 0;
  virtual const IndexPairs& excluded() const = 0;
  virtual const Surface& topology() const = 0;
};

/// A session in one box, with an accepted state and the goal of the call before, as after a restore. Positions are
/// given without those of obstacles.
/// @param obstacles positions of the last vertices of the surface, (k, 3)
/// @throws as EditSession; StartIntersectsError is about the accepted state
std::unique_ptr<SessionImplementation> make_surface_session(std::shared_ptr<const Surface> surface, Positions obstacles,
                                                            std::shared_ptr<const Deformation> deformation,
                                                            const Controls& start, EditOptions options,
                                                            const Controls& accepted, const Controls& goal,
                                                            Execution& execution);

}  // namespace stiv
