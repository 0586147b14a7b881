// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stiv/vector_target.hpp"

namespace stiv {

/// Results of `work()` with each of the vector targets that this machine has, in ascending order.
template <class Work>
auto for_each_vector_target(const Work& work) {
  std::vector<decltype(work())> results;
  const VectorTarget before = vector_target();
  for (int target = 0; target <= static_cast<int>(best_vector_target()); ++target) {
    limit_vector_target(static_cast<VectorTarget>(target));
    results.push_back(work());
  }
  limit_vector_target(before);
  return results;
}

}  // namespace stiv
