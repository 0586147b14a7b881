// SPDX-License-Identifier: GPL-3.0-or-later
#include "penetration/depth_watch.hpp"

namespace stiv {

std::vector<unsigned char> displaced_bodies(const Surface& surface, const Positions& from, const Positions& to) {
  std::vector<unsigned char> displaced(surface.bodies().size(), 0);
  for (Index vertex = 0; vertex < surface.vertex_count(); ++vertex)
    if (from.row(vertex) != to.row(vertex)) displaced[at(surface.body_of(vertex))] = 1;
  return displaced;
}

void DepthWatch::begin(const Positions& q, const IndexPairs& intersecting) {
  penetrations_.emplace(surface_, excluded_, q, rounding_);
  last_.assign(penetrations_->pairs().size(), {});
  penetrations_->update(last_, std::vector<unsigned char>(surface_->bodies().size(), 1), q, intersecting);
  last_positions_ = q;
  at_start_ = last_;
}

bool DepthWatch::is_deeper(const Positions& q, const IndexPairs& intersecting) {
  if (last_.empty()) return false;
  penetrations_->update(last_, displaced_bodies(*surface_, last_positions_, q), q, intersecting);
  last_positions_ = q;
  for (std::size_t k = 0; k < last_.size(); ++k)
    if (last_[k].amount - last_[k].uncertainty > at_start_[k].amount) return true;
  return false;
}

}  // namespace stiv
