// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "detection/broad_phase/bounds.hpp"
#include "detection/broad_phase/candidate_source.hpp"
#include "detection/broad_phase/group_frames.hpp"
#include "detection/filters/coarse_hull_filter.hpp"
#include "large_array.hpp"

namespace stiv {

/// Boxes of the swept vertices, cached from step to step. Only vertices with a different step get a new box, and none
/// does while all stay within their boxes. A box is active if its vertex moves.
///
/// The padding covers the separation and the error of the narrow phase. It also covers `slack` times the vertex's
/// displacement, in the common frame or in its own if that is more, so that steps from the same start stay inside if
/// they end near the segment of the vertex. (mathematics.md, "Boxes" and "Rounds of one edit")
class SweptVertices {
 public:
  explicit SweptVertices(const Surface& surface) : surface_(surface) {}

  /// As CandidateSource.
  void set_resting(Index count) { resting_ = count; }
  /// The number of the first vertices, which may change.
  Index changing() const { return surface_.vertex_count() - resting_; }

  /// Whether boxes that contain the step may be reused.
  enum class Reuse { allowed, forbidden };

  enum class Change {
    none,  ///< the start and all boxes are unchanged; they contain the new step
    some,  ///< the boxes of `changed` are new
    all
  };

  /// @throws InputError as Surface::check_positions
  Change update(const Step& step, const Execution& execution, Reuse reuse = Reuse::allowed);

  /// Takes a step, (N, 3) each, that begins and ends near the start of the boxes' step, or near its end. Pairs whose
  /// boxes or hulls stayed apart by the separation do not touch in it. Otherwise returns false, with nothing changed: a
  /// vertex is further away than an eighth of the separation, or moves but did not in the boxes' step.
  /// (mathematics.md, "Steps as short as rounding")
  bool take_short_step(const PositionsView& start, const PositionsView& end, const Execution& execution);

  /// Fraction of a vertex's displacement in the frame (its largest component) by which its box is padded. Small,
  /// because responses change a step by far more than padding can cover.
  static constexpr double slack = 1.0 / 1024;
  /// The displacements of the frames of the boxes.
  const FrameMotions& motions() const { return motions_; }
  /// The same as the boxes' groups, one for each body.
  GroupFrames body_frames() const;

  /// The step that was taken last.
  const VertexSteps& steps() const { return steps_; }
  /// The steps of the boxes in single precision, in a frame with the common motion.
  const LargeArray<CoarseStep>& coarse_steps() const { return coarse_steps_; }
  const CoarseFrame& coarse_frame() const { return coarse_frame_; }
  /// Bounds of the gaps between these steps that allow for the slack.
  CoarseBounds coarse_bounds() const { return {coarse_frame_, frame_.separation, slack, coarse_reach_}; }
  const LargeArray<PackedBox>& boxes() const { return boxes_; }
  const std::vector<Index>& changed() const { return changed_; }
  /// 1 for each body with a changed vertex. Known after a change of `some`.
  const std::vector<unsigned char>& changed_bodies() const { return changed_bodies_; }

  /// Union of the boxes of some vertices.
  template <class Vertices>
  PackedBox box_of(const Vertices& vertices) const {
    PackedBox box = boxes_[vertices[0]];
    for (std::size_t k = 1; k < static_cast<std::size_t>(vertices.size()); ++k) box.include(boxes_[vertices[k]]);
    return box;
  }

 private:
  /// The parameters that all frames share. They change as rarely as possible, so that boxes stay valid.
  struct Frame {
    Vector3 centre = Vector3::Zero();
    Vector3 motion = Vector3::Zero();  ///< the common one
    double radius = -1;                ///< bound of the coordinates relative to the center, at the start and at the end
    double separation = 0;

    bool operator==(const Frame&) const = default;
    double margin() const;
  };
  struct Survey;

  std::vector<Index> changed_in(const Step& step, const Execution& execution) const;
  Survey survey(const Step& step, const Execution& execution) const;
  void take_steps(const Step& step, const Execution& execution);
  Frame frame_for(const Step& step, const Survey& survey) const;
  PackedBox box(const Step& step, Index vertex) const;
  bool has_other_frame(const Step& step, Index vertex) const;
  bool near_segment(const Step& step, Index vertex) const;
  bool near_segment(const Step& step, Index vertex, const Vector3& frame_motion, const Vector3& step_motion) const;
  bool holds(const Step& step, const Execution& execution) const;
  bool stays_near(const Positions& surface, const Step& step, const Execution& execution) const;
  std::int32_t make_boxes(std::span<const Index> vertices);
  std::int32_t make_framed_boxes(const Step& step, std::span<const Index> vertices);
  void sweep(const Step& step, const std::vector<Index>& vertices, const Execution& execution);

  const Surface& surface_;
  Index resting_ = 0;  ///< vertices
  Frame frame_;
  FrameMotions motions_;
  Positions start_, end_;  // of the step for which each box was computed, of the vertices that may change
  LargeArray<PackedBox> boxes_;
  LargeArray<CoarseStep> coarse_steps_;
  CoarseFrame coarse_frame_;
  std::int32_t coarse_reach_ = 0;  // no less than that of any coarse step
  std::vector<Index> changed_;
  std::vector<unsigned char> changed_bodies_;
  VertexSteps steps_;
  std::vector<Index> outdated_;  // vertices whose step in `steps_` may differ from that of their box
  bool complete_ = false;        // each vertex has a box in this frame
};

}  // namespace stiv
