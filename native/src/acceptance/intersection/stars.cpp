// SPDX-License-Identifier: GPL-3.0-or-later
#include "acceptance/intersection/stars.hpp"

#include <algorithm>
#include <array>
#include <span>

#include "acceptance/intersection/star_proof.hpp"

namespace stiv {

namespace {

/// The side of a triangle opposite to a vertex, in its direction of turning.
struct Spoke {
  Index from, to;
};

/// Spokes of each vertex, in compressed rows.
struct SpokeTable {
  std::vector<std::size_t> start;
  std::vector<Spoke> spokes;

  SpokeTable(const std::vector<std::array<Index, 3>>& triangles, Index vertex_count) : start(at(vertex_count) + 2, 0) {
    for (const auto& corners : triangles)
      for (const Index corner : corners) ++start[at(corner) + 2];
    for (std::size_t k = 2; k < start.size(); ++k) start[k] += start[k - 1];
    spokes.resize(3 * triangles.size());
    for (const auto& [a, b, c] : triangles) {
      spokes[start[at(a) + 1]++] = {b, c};
      spokes[start[at(b) + 1]++] = {c, a};
      spokes[start[at(c) + 1]++] = {a, b};
    }
  }
  std::span<Spoke> of(Index vertex) {
    return {spokes.data() + start[at(vertex)], spokes.data() + start[at(vertex) + 1]};
  }
};

/// Puts spokes into the order in which each begins where the one before ends. False if they are not one such chain, in
/// which no vertex begins or ends two.
bool chain(std::span<Spoke> spokes) {
  for (std::size_t k = 0; k < spokes.size(); ++k)
    for (std::size_t other = 0; other < spokes.size(); ++other)
      if (other != k && (spokes[k].from == spokes[other].from || spokes[k].to == spokes[other].to)) return false;
  const auto begins_chain = [&](const Spoke& spoke) {
    return std::none_of(spokes.begin(), spokes.end(), [&](const Spoke& before) { return before.to == spoke.from; });
  };
  const auto first = std::find_if(spokes.begin(), spokes.end(), begins_chain);
  if (first != spokes.end()) std::swap(*first, spokes.front());
  for (std::size_t k = 0; k + 1 < spokes.size(); ++k) {
    const auto next = std::find_if(spokes.begin() + static_cast<std::ptrdiff_t>(k) + 1, spokes.end(),
                                   [&](const Spoke& spoke) { return spoke.from == spokes[k].to; });
    if (next == spokes.end()) return false;
    std::swap(*next, spokes[k + 1]);
  }
  return true;
}

/// Of one triangle alone, nothing is to be left out; stars of many are left to the tests of pairs, which are more work
/// by then in any case.
bool may_be_proven(std::span<Spoke> spokes) {
  return spokes.size() > 1 && spokes.size() <= StarBlock::most_triangles && chain(spokes);
}

}  // namespace

Stars::Stars(const std::vector<std::array<Index, 3>>& triangles, Index vertex_count) {
  SpokeTable table(triangles, vertex_count);
  start_.reserve(at(vertex_count) + 1);
  rims_.reserve(table.spokes.size() + at(vertex_count));
  for (Index vertex = 0; vertex < vertex_count; ++vertex) {
    start_.push_back(static_cast<Index>(rims_.size()));
    const std::span<Spoke> spokes = table.of(vertex);
    if (!may_be_proven(spokes)) continue;
    stars_.push_back(vertex);
    for (const Spoke& spoke : spokes) rims_.push_back(spoke.from);
    rims_.push_back(spokes.back().to);
  }
  start_.push_back(static_cast<Index>(rims_.size()));
  std::stable_sort(stars_.begin(), stars_.end(), [this](Index a, Index b) { return shape(a) < shape(b); });
}

std::vector<unsigned char> Stars::find_free(const PointRows& points, const std::vector<unsigned char>& moved,
                                            const Execution& execution) const {
  constexpr Index chunk_size = 4096;
  std::vector<unsigned char> free(points.size(), 0);
  const auto has_moved = [&](Index vertex) { return moved[at(vertex)] != 0; };
  execution.for_chunks(static_cast<Index>(stars_.size()), chunk_size, [&](Index begin, Index end, Index) {
    StarBlock block;
    const auto prove = [&] {
      if (block.count == 0) return;
      const auto proven = prove_free(block, points);
      for (std::size_t k = 0; k < block.count; ++k) free[at(block.vertices[k])] = proven[k];
      block.count = 0;
    };
    for (std::size_t k = at(begin); k < at(end); ++k) {
      const Index vertex = stars_[k];
      const std::span<const Index> around = rim(vertex);
      if (!moved.empty() && !has_moved(vertex) && std::none_of(around.begin(), around.end(), has_moved)) continue;
      const auto [triangles, closed] = shape(vertex);
      if (block.count == StarBlock::capacity || triangles != block.triangles || closed != block.closed) prove();
      block.triangles = triangles;
      block.closed = closed;
      block.vertices[block.count] = vertex;
      block.rims[block.count] = around.data();
      ++block.count;
    }
    prove();
  });
  return free;
}

std::pair<std::size_t, bool> Stars::shape(Index vertex) const {
  const std::span<const Index> around = rim(vertex);
  return {around.size() - 1, around.front() == around.back()};
}

std::span<const Index> Stars::rim(Index vertex) const {
  const auto begin = rims_.begin() + start_[at(vertex)], end = rims_.begin() + start_[at(vertex) + 1];
  return {begin, end};
}

}  // namespace stiv
