// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "editing/control_limits.hpp"
#include "editing/moving_part.hpp"
#include "editing/scene_rows.hpp"
#include "stiv/deformation/deformation.hpp"
#include "stiv/editing/options.hpp"
#include "stiv/execution.hpp"
#include "stiv/surface.hpp"

namespace stiv {

/// Controls and their surface, in world coordinates; without the obstacles.
struct State {
  Controls controls;
  Positions surface;
};

/// The validated input of a session, and data derived from it once. Only the weights and the metric can change.
class EditContext {
 public:
  /// @param obstacles the last vertices of the surface, (k, 3), which are not the deformation's and never move
  /// @throws InputError for shapes and values that do not fit
  EditContext(std::shared_ptr<const Surface> surface, Positions obstacles,
              std::shared_ptr<const Deformation> deformation, const Controls& start, EditOptions options,
              const Execution& execution);
  EditContext(const EditContext&) = delete;  // proximities point into it
  EditContext& operator=(const EditContext&) = delete;

  /// With the obstacles.
  const Surface& surface() const { return *surface_; }
  const std::shared_ptr<const Surface>& shared_surface() const { return surface_; }
  const Deformation& deformation() const { return *deformation_; }
  const Positions& obstacles() const { return obstacles_; }
  /// Relative to the center, as `centred`.
  const Positions& centred_obstacles() const { return centred_obstacles_; }
  const Metric& metric() const { return *metric_; }
  static constexpr int tight_levels = 3;
  /// The metric with a tenth of the damping, or a hundredth and so on for further levels. Factored at its first use.
  const Metric& tight_metric(int level) const;
  /// With the effective separation.
  const EditOptions& options() const { return options_; }
  /// Rows of the controls that are interpolated as rotations.
  const std::vector<Index>& rotation_rows() const { return rotation_rows_; }
  /// Of accepted states.
  const Proximity& proximity() const { return proximity_; }
  /// Of the rounds. Published volumes without a separation have none here.
  const Proximity& round_proximity() const { return round_proximity_; }
  /// The least separation that survives storing.
  double least_separation() const { return least_separation_; }
  /// A goal is far if a vertex is further from it than this: a quarter of the diagonal of the moving vertices.
  double far_distance() const { return 0.25 * diagonal_; }
  /// Largest displacement of a vertex of the goal in a pull; 0: no pulls.
  double pull_distance() const { return options_.pull_limit * diagonal_; }
  /// Does a large body move? Calls then take steps that need fewer searches.
  bool has_large_body() const { return large_body_edge_ > 0; }
  /// With a large body, the longest motion in which the first search of a pull looks for contacts: an edge.
  double first_reach() const { return large_body_edge_; }
  /// @throws InputError, with nothing changed
  void set_weights(Eigen::VectorXd weights, std::vector<Eigen::Matrix3d> weight_axes);
  /// Factors the metric again if the Jacobian was replaced, and returns whether it was.
  bool renew_metric();
  /// As MovingPart.
  double energy(const Positions& a, const Positions& b) const { return moving_part_.energy(a, b); }
  double longest_displacement(const Positions& from, const Positions& to) const {
    return moving_part_.longest_displacement(from, to);
  }
  const Eigen::VectorXd& region_areas(const Positions& q, const Execution& execution) const {
    return moving_part_.region_areas(q, execution);
  }
  bool is_empty() const { return deformation_->control_count() == 0 || surface_->vertex_count() == 0; }

  /// @param name of the argument: "controls" or "goal"
  /// @throws InputError for a shape or values that do not fit; names object and control
  void check_controls(const Controls& controls, const char* name) const;
  const ControlLimits& limits() const { return limits_; }
  /// As they are read back from storage, within the limits.
  Controls stored(const Controls& controls) const {
    return limits_.nearest_stored(as_stored(controls, options_.storage));
  }
  /// @throws InfeasibleError
  Positions surface_at(const Controls& controls, Execution& execution) const;
  /// Relative to the center of the start without the obstacles: smaller coordinates round less.
  void centre(PositionRows q) const;
  /// The same for a surface, with the obstacles.
  const Positions& centred(const PositionsView& q, SceneRows& rows, const Execution& execution) const;
  /// @throws InputError if a surface, without the obstacles, has another shape or coordinates out of range
  void check_positions(const PositionsView& q, const Execution& execution) const;

 private:
  void set_proximity(const Positions& start, const Controls& controls);

  std::shared_ptr<const Surface> surface_;
  Positions obstacles_, centred_obstacles_;
  MovingPart moving_part_;
  std::shared_ptr<const Deformation> deformation_;
  EditOptions options_;
  ControlLimits limits_;
  std::vector<Index> rotation_rows_;
  std::uint64_t revision_;  ///< of the deformation, for the metric
  std::unique_ptr<Metric> metric_;
  mutable std::array<std::unique_ptr<Metric>, tight_levels> tight_metrics_;
  Eigen::RowVector3d centre_ = Eigen::RowVector3d::Zero();
  double diagonal_ = 0;  ///< of the moving vertices
  double least_separation_ = 0;
  double large_body_edge_ = 0;  ///< mean length; 0: no large body
  std::optional<BodySeparations> body_separations_;
  std::optional<BodyPairSet> overlapping_;
  Positions reference_;  ///< the start with the obstacles, centered
  Proximity proximity_, round_proximity_;
};

}  // namespace stiv
