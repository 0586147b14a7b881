// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>

#include "detection/broad_phase/bounds.hpp"
#include "detection/broad_phase/vertex_steps.hpp"
#include "detection/filters/coarse_hull_filter.hpp"

namespace stiv {

/// A frame that the boxes of all bodies share.
struct CommonFrame {
  double centre[4];      ///< x, y, z, 0
  double motion[4];      ///< the same
  double end_centre[4];  ///< that of coarse steps
  double margin;         ///< of all boxes
  double slack;          ///< of a box for each unit of the vertex's displacement in the frame
  double to_units;       ///< of coarse steps
};

/// Computes boxes and coarse steps of some vertices in vector code, with the bits of SweptVertices::box and
/// CoarseFrame::step. Returns the largest reach of these coarse steps.
std::int32_t make_common_boxes(const CommonFrame& frame, const VertexStep* steps, std::span<const Index> vertices,
                               PackedBox* boxes, CoarseStep* coarse);

}  // namespace stiv
