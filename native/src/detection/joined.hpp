// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

namespace stiv {

/// What chunks gave, one after the other, in no more memory than it takes.
template <class Part>
std::vector<Part> joined(std::span<const std::vector<Part>> parts) {
  std::size_t count = 0;
  for (const std::vector<Part>& part : parts) count += part.size();
  std::vector<Part> all;
  all.reserve(count);
  for (const std::vector<Part>& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace stiv
