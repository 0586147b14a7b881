// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "stiv/types.hpp"

namespace stiv {

/// Indices of two primitives.
struct PrimitivePair {
  Index first = 0;
  Index second = 0;
};

/// Two indices, not negative, as one number that sorts as the pair does.
inline std::uint64_t pair_key(Index first, Index second) {
  return static_cast<std::uint64_t>(first) << 32 | static_cast<std::uint64_t>(second);
}

/// The results of all chunks in order, in exactly the memory that they need.
template <class Item>
std::vector<Item> concatenate(std::span<const std::vector<Item>> chunks) {
  std::size_t count = 0;
  for (const std::vector<Item>& chunk : chunks) count += chunk.size();
  std::vector<Item> all;
  all.reserve(count);
  for (const std::vector<Item>& chunk : chunks) all.insert(all.end(), chunk.begin(), chunk.end());
  return all;
}

}  // namespace stiv
