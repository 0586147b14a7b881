// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <utility>
#include <vector>

#include "detection/motions.hpp"
#include "detection/plane_filter.hpp"

namespace stiv {

/// Pairs of motions side by side, four vertices each.
struct Batch {
  std::vector<PairMotion> motions;
  Positions start, end;
  PairBlock block;
  VertexSteps vertices;

  Batch(std::vector<PairMotion> of) : motions(std::move(of)) {
    start.resize(static_cast<Index>(4 * motions.size()), 3);
    end = start;
    Index row = 0;
    for (const PairMotion& motion : motions) {
      block.add({row, row + 1, row + 2, row + 3});
      for (std::size_t k = 0; k < 4; ++k, ++row) {
        start.row(row) = motion.start[k];
        end.row(row) = motion.end[k];
      }
    }
    vertices.update(start, end, Execution(1));
  }
};

inline Batch batch_of(MotionMaker& make, int sort, std::size_t count) {
  std::vector<PairMotion> motions;
  for (std::size_t k = 0; k < count; ++k) motions.push_back(make.make(sort));
  return Batch(std::move(motions));
}

/// Of the block's pairs, those that `find(kind, block, vertices, separation, flags)` flags.
template <class Find>
std::vector<unsigned char> flagged(const Find& find, EventKind kind, const Batch& batch, double separation) {
  PairFlags found{};
  find(kind, batch.block, batch.vertices, separation, found);
  return {found.begin(), found.begin() + static_cast<std::ptrdiff_t>(batch.block.count)};
}

}  // namespace stiv
