// SPDX-License-Identifier: GPL-3.0-or-later
#include "chunk_shares.hpp"

#include <doctest/doctest.h>

#include <vector>

using namespace stiv;

TEST_CASE("chunk shares: threads take their own shares first, and then the last chunks of others") {
  ChunkShares shares(7, 2);
  std::vector<Index> first, second;
  for (int k = 0; k < 2; ++k) first.push_back(shares.take(0));
  for (Index chunk = shares.take(1); chunk >= 0; chunk = shares.take(1)) second.push_back(chunk);
  CHECK(first == std::vector<Index>{0, 1});
  CHECK(second == std::vector<Index>{3, 4, 5, 6, 2});
  CHECK(shares.take(0) == -1);
}

TEST_CASE("chunk shares: each chunk is taken once, also with more threads than chunks") {
  for (const int threads : {1, 3, 8})
    for (const Index chunks : {0, 1, 5, 100}) {
      ChunkShares shares(chunks, threads);
      std::vector<int> taken(static_cast<std::size_t>(chunks), 0);
      for (Index k = 0; k < chunks; ++k) {
        const Index chunk = shares.take((7 * k) % threads);
        REQUIRE(chunk >= 0);
        ++taken[static_cast<std::size_t>(chunk)];
      }
      for (int thread = 0; thread < threads; ++thread) CHECK(shares.take(thread) == -1);
      CHECK(taken == std::vector<int>(taken.size(), 1));
    }
}
