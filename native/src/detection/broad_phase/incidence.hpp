// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "stiv/types.hpp"

namespace stiv {

/// Which rows of a table of vertices name a vertex.
class Incidence {
 public:
  /// @param rows (count, size) vertex numbers
  Incidence(const Index* rows, Index count, Index size, Index vertex_count)
      : start_(static_cast<std::size_t>(vertex_count) + 2, 0) {
    const std::size_t entries = static_cast<std::size_t>(count) * static_cast<std::size_t>(size);
    for (std::size_t k = 0; k < entries; ++k) ++start_[static_cast<std::size_t>(rows[k]) + 2];
    for (std::size_t k = 2; k < start_.size(); ++k) start_[k] += start_[k - 1];
    rows_.resize(entries);
    for (std::size_t k = 0; k < entries; ++k)
      rows_[static_cast<std::size_t>(start_[static_cast<std::size_t>(rows[k]) + 1]++)] =
          static_cast<Index>(k / static_cast<std::size_t>(size));
  }

  /// Rows that name any of the vertices, some more than once; valid until the next call.
  std::span<const Index> rows_with(std::span<const Index> vertices) {
    found_.clear();
    for (const Index vertex : vertices) {
      const auto begin = start_[static_cast<std::size_t>(vertex)], end = start_[static_cast<std::size_t>(vertex) + 1];
      found_.insert(found_.end(), rows_.begin() + begin, rows_.begin() + end);
    }
    return found_;
  }

 private:
  std::vector<std::ptrdiff_t> start_;  // of the rows of each vertex
  std::vector<Index> rows_, found_;
};

}  // namespace stiv
