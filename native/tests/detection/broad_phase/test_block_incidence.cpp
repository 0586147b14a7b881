// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <algorithm>
#include <random>
#include <set>

#include "detection/broad_phase/block_incidence.hpp"

using namespace stiv;

TEST_CASE("block incidence: each block at a vertex once, those of a run of vertices in one list") {
  constexpr std::size_t block_size = 24, blocks = 200;
  constexpr Index vertices = 150;
  std::mt19937 random(3);
  std::uniform_int_distribution<Index> any(-1, vertices - 2);  // -1: no primitive; nothing has the last vertex
  std::vector<Index> corners;
  for (std::size_t k = 0; k < blocks * block_size; ++k) corners.push_back(any(random));
  const BlockIncidence incidence(corners, block_size, vertices);
  for (Index begin = 0; begin < vertices; begin += 7) {
    const Index end = std::min(vertices, begin + 1 + begin % 5);
    std::multiset<Index> expected;
    for (Index vertex = begin; vertex < end; ++vertex)
      for (std::size_t block = 0; block < blocks; ++block) {
        const auto first = corners.begin() + static_cast<std::ptrdiff_t>(block * block_size), last = first + block_size;
        if (std::find(first, last, vertex) != last) expected.insert(static_cast<Index>(block));
      }
    const auto found = incidence.blocks_at(begin, end);
    CHECK(std::multiset<Index>(found.begin(), found.end()) == expected);
    const BlockIncidence of_first(corners, block_size, end);
    const auto found_among_first = of_first.blocks_at(begin, end);
    CHECK(std::multiset<Index>(found_among_first.begin(), found_among_first.end()) == expected);
  }
}
