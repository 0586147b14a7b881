// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/swept_bounds.hpp"

namespace stiv {

namespace {

constexpr Index chunk_size = 8192;

std::size_t at(Index index) { return static_cast<std::size_t>(index); }

struct Frame {
  Vector3 centre = Vector3::Zero();
  Vector3 motion = Vector3::Zero();
  double margin = 0;
};

// A pair is reported at most (1 + 1e-3) h + 5 * 2^-46 M apart (or where its own boxes overlap at that distance), with M
// no larger than the extent of the scene and its motion. Each of two boxes is padded by more than half of that.
Frame frame_of(const Step& step) {
  Frame frame;
  if (step.start.rows() == 0) return frame;
  const Vector3 low = step.start.colwise().minCoeff(), high = step.start.colwise().maxCoeff();
  frame.centre = low / 2 + high / 2;
  frame.motion = (step.end - step.start).colwise().mean();
  if (!frame.motion.allFinite()) frame.motion.setZero();
  const double extent = (high - low).maxCoeff() + (step.end - step.start).cwiseAbs().maxCoeff();
  frame.margin = 0.55 * step.proximity.separation + 0x1p-42 * extent;
  return frame;
}

template <class Corners>
void unite(const Corners& corners, const SweptBounds& swept, const Execution& execution, std::vector<Bounds>& boxes,
           std::vector<unsigned char>& moves) {
  const auto count = static_cast<Index>(corners.rows());
  boxes.resize(at(count));
  moves.resize(at(count));
  execution.for_chunks(count, chunk_size, [&](Index begin, Index end, Index) {
    for (Index row = begin; row < end; ++row) {
      Bounds box = swept.vertices[at(corners(row, 0))];
      unsigned char moved = swept.vertex_moves[at(corners(row, 0))];
      for (Index k = 1; k < corners.cols(); ++k) {
        box.include(swept.vertices[at(corners(row, k))]);
        moved |= swept.vertex_moves[at(corners(row, k))];
      }
      boxes[at(row)] = box;
      moves[at(row)] = moved;
    }
  });
}

}  // namespace

void sweep_bounds(const Surface& surface, const Step& step, const Execution& execution, SweptBounds& swept) {
  const Frame frame = frame_of(step);
  swept.vertices.resize(at(surface.vertex_count()));
  execution.for_chunks(surface.vertex_count(), chunk_size, [&](Index begin, Index end, Index) {
    for (Index vertex = begin; vertex < end; ++vertex) {
      Bounds box = Bounds::empty();
      box.include(step.start.row(vertex).transpose() - frame.centre, frame.margin);
      box.include(step.end.row(vertex).transpose() - frame.centre - frame.motion, frame.margin);
      swept.vertices[at(vertex)] = box;
    }
  });
  swept.vertex_moves = moved_vertices(step);
  unite(surface.edges(), swept, execution, swept.edges, swept.edge_moves);
  unite(surface.triangles(), swept, execution, swept.faces, swept.face_moves);
}

}  // namespace stiv
