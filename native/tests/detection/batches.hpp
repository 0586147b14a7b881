// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <doctest/doctest.h>

#include <utility>
#include <vector>

#include "detection/filters/pair_filters.hpp"
#include "detection/motions.hpp"
#include "detection/reference.hpp"
#include "vector_targets.hpp"

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

struct FilterCounts {
  std::size_t apart = 0, all = 0;
};

/// Checks that all kinds of pairs that a filter flags keep the separation, and that every vector target gives the same
/// result.
template <class Find>
FilterCounts check_filter(const Find& find, unsigned seed) {
  MotionMaker make(seed);
  FilterCounts counts;
  for (int sort = 0; sort < MotionMaker::sort_count; ++sort)
    for (const std::size_t count : {std::size_t{1}, std::size_t{3}, std::size_t{13}, PairBlock::capacity})
      for (const EventKind kind : {EventKind::vertex_face, EventKind::edge_edge}) {
        const Batch batch = batch_of(make, sort, count);
        const double separation = 0.05 * make.number(0, 1);
        const auto flags = for_each_vector_target([&] { return flagged(find, kind, batch, separation); });
        for (const auto& other : flags) CHECK(other == flags.front());
        for (std::size_t k = 0; k < count; ++k) {
          counts.all += 1;
          counts.apart += flags.front()[k];
          if (flags.front()[k] == 0) continue;
          CHECK(reference::first_time(kind, batch.motions[k], separation, 1e-5L).least > separation);
        }
      }
  return counts;
}

}  // namespace stiv
