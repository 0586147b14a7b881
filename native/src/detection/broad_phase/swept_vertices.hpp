// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "detection/broad_phase/bounds.hpp"
#include "detection/broad_phase/candidate_source.hpp"

namespace stiv {

/// Boxes of the moving vertices, kept from step to step: only vertices whose step is another get another box, and none
/// does as long as all of them stay within the boxes that they have. A box is active if its vertex moves.
///
/// Boxes are padded so that pairs that come within the separation, by whatever the narrow phase may err, overlap; and
/// by `slack` times the vertex's displacement, so that other ends of the same start stay inside: those within the slack
/// of the segment that the vertex moves along.
class SweptVertices {
 public:
  explicit SweptVertices(const Surface& surface) : surface_(surface) {}

  enum class Change {
    none,  ///< the start is as it was, and so are all boxes; they hold the new step
    some,  ///< those of `changed` are new
    all
  };

  /// @param may_stay false: boxes that hold the step are made anew all the same
  /// @throws InputError as Surface::check_positions
  Change update(const Step& step, const Execution& execution, bool may_stay = true);

  /// Boxes grow by this part of the displacement of their vertex in the frame, its largest component.
  /// Little, for what responses change of a step is far more than boxes can be padded by.
  static constexpr double slack = 1.0 / 1024;
  /// The displacement of the frame that boxes are seen from.
  const Vector3& motion() const { return frame_.motion; }

  /// The step of the last update.
  const VertexSteps& steps() const { return steps_; }
  const std::vector<PackedBox>& boxes() const { return boxes_; }
  const std::vector<Index>& changed() const { return changed_; }

  /// Union of the boxes of some vertices.
  template <class Vertices>
  PackedBox box_of(const Vertices& vertices) const {
    PackedBox box = boxes_[vertices[0]];
    for (std::size_t k = 1; k < static_cast<std::size_t>(vertices.size()); ++k) box.include(boxes_[vertices[k]]);
    return box;
  }

 private:
  /// Where boxes are seen from. It stays the same from step to step where it can, so that boxes stay the same.
  struct Frame {
    Vector3 centre = Vector3::Zero();
    Vector3 motion = Vector3::Zero();  ///< displacement in a step, see common_motion
    double radius = -1;                ///< no coordinate is farther from the centre, at the start or at the end
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
  bool near_segment(const Step& step, Index vertex) const;
  bool holds(const Step& step, const Execution& execution) const;
  void sweep(const Step& step, const std::vector<Index>& vertices, const Execution& execution);

  const Surface& surface_;
  Frame frame_;
  Positions start_, end_;  // for which each box was made
  std::vector<PackedBox> boxes_;
  std::vector<Index> changed_;
  VertexSteps steps_;
  std::vector<Index> outdated_;  // vertices whose step in `steps_` may differ from that of their box
  bool complete_ = false;        // there is a box for each vertex, all seen from the frame
};

}  // namespace stiv
