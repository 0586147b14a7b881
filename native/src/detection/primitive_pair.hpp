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

/// Finds the primitives at a vertex.
class VertexIncidence {
 public:
  /// @param primitives (count, size) vertices of edges (size 2) or triangles (size 3)
  VertexIncidence(const Index* primitives, Index count, Index size, Index vertex_count)
      : start_(static_cast<std::size_t>(vertex_count) + 2, 0) {
    const std::size_t entries = static_cast<std::size_t>(count) * static_cast<std::size_t>(size);
    for (std::size_t k = 0; k < entries; ++k) ++start_[static_cast<std::size_t>(primitives[k]) + 2];
    for (std::size_t k = 2; k < start_.size(); ++k) start_[k] += start_[k - 1];
    primitives_.resize(entries);
    for (std::size_t k = 0; k < entries; ++k)
      primitives_[start_[static_cast<std::size_t>(primitives[k]) + 1]++] =
          static_cast<Index>(k / static_cast<std::size_t>(size));
  }

  /// Primitives with any of the vertices, some of them repeatedly; valid until the next call.
  std::span<const Index> primitives_with(std::span<const Index> vertices) {
    found_.clear();
    for (const Index vertex : vertices) {
      const auto begin = start_[vertex], end = start_[static_cast<std::size_t>(vertex) + 1];
      found_.insert(found_.end(), primitives_.begin() + begin, primitives_.begin() + end);
    }
    return found_;
  }

 private:
  std::vector<std::ptrdiff_t> start_;  // first entry of each vertex
  std::vector<Index> primitives_, found_;
};

}  // namespace stiv
