// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/depth_watch.hpp"

namespace stiv {

bool DepthWatch::is_deeper(const Positions& q, const IndexPairs& intersecting) const {
  if (volumes_.empty()) return false;
  const auto now = volumes_.at(q, intersecting);
  for (std::size_t k = 0; k < at_start_.size(); ++k) {
    if (!at_start_[k]) continue;
    if (!now[k]) return true;
    if (now[k]->volume > at_start_[k]->volume + rounding_ * (at_start_[k]->area + now[k]->area)) return true;
  }
  return false;
}

}  // namespace stiv
