// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stiv/detection/event.hpp"

namespace stiv {

/// Are all numbers of all events the same?
inline bool same_bits(const Events& a, const Events& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t k = 0; k < a.size(); ++k) {
    const bool same = a[k].kind == b[k].kind && a[k].vertices == b[k].vertices && a[k].time == b[k].time &&
                      a[k].weights == b[k].weights && a[k].normal == b[k].normal &&
                      a[k].start_distance == b[k].start_distance;
    if (!same) return false;
  }
  return true;
}

}  // namespace stiv
