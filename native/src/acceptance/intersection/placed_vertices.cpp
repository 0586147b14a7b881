// SPDX-License-Identifier: GPL-3.0-or-later
#include "acceptance/intersection/placed_vertices.hpp"

#include <algorithm>

namespace stiv {

namespace {

constexpr Index chunk_size = 4096;

}  // namespace

bool PlacedVertices::is_placed(const PositionsView& q, Index vertex, bool active) const {
  const double* const point = points_[at(vertex)].coordinates;
  return point[0] == q(vertex, 0) && point[1] == q(vertex, 1) && point[2] == q(vertex, 2) &&
         boxes_[at(vertex)].active() == active;
}

void PlacedVertices::place(const PositionsView& q, Index vertex, bool active) {
  Bounds bounds = Bounds::empty();
  bounds.include(q.row(vertex).transpose(), margin_);
  points_[at(vertex)] = {{q(vertex, 0), q(vertex, 1), q(vertex, 2), 0}};
  boxes_[at(vertex)] = PackedBox::of(bounds, active);
}

void PlacedVertices::update(const PositionsView& q, const std::vector<unsigned char>& moved, double margin,
                            const Execution& execution) {
  const auto rows = static_cast<Index>(q.rows()), moving = rows - resting_;
  const bool is_first = points_.empty() || margin != margin_;
  margin_ = margin;
  points_.resize(at(rows));
  boxes_.resize(at(rows));
  const Index count = is_first ? rows : moving;
  std::vector<std::vector<Index>> changed(at(Execution::chunk_count(count, chunk_size)));
  execution.for_chunks(count, chunk_size, [&](Index begin, Index end, Index chunk) {
    std::vector<Index>& bodies = changed[at(chunk)];
    for (Index vertex = begin; vertex < end; ++vertex) {
      const bool active = vertex < moving && (moved.empty() || moved[at(vertex)] != 0);
      if (!is_first && is_placed(q, vertex, active)) continue;
      place(q, vertex, active);
      const Index body = surface_->body_of(vertex);
      if (bodies.empty() || bodies.back() != body) bodies.push_back(body);
    }
  });
  changed_bodies_.assign(surface_->bodies().size(), is_first ? 1 : 0);
  for (const std::vector<Index>& bodies : changed)
    for (const Index body : bodies) changed_bodies_[at(body)] = 1;
}

}  // namespace stiv
