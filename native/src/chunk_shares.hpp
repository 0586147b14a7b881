// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <vector>

#include "stiv/types.hpp"

namespace stiv {

/// The chunks of a loop, shared out among threads. A thread takes the chunks of its own share first, in ascending
/// order, and then the last ones of others. So loops over the same rows mostly give a row to the same thread, which has
/// it in its cache: processors with caches of their own are slow to read what another one has written.
class ChunkShares {
 public:
  ChunkShares(Index chunks, int threads) : shares_(at(std::max<Index>(1, std::min<Index>(threads, chunks)))) {
    const auto count = static_cast<std::int64_t>(shares_.size());
    for (std::int64_t k = 0; k < count; ++k)
      shares_[static_cast<std::size_t>(k)].left = range(k * chunks / count, (k + 1) * chunks / count);
  }

  /// The next chunk of a thread; -1: none is left.
  Index take(int thread) {
    const std::size_t count = shares_.size(), own = static_cast<std::size_t>(thread);
    if (own < count)
      if (const Index chunk = take_from(shares_[own], End::first); chunk >= 0) return chunk;
    for (std::size_t k = 1; k <= count; ++k)
      if (const Index chunk = take_from(shares_[(own + k) % count], End::last); chunk >= 0) return chunk;
    return -1;
  }

 private:
  enum class End { first, last };

  struct alignas(64) Share {  // a line of the cache each
    std::atomic<std::uint64_t> left;
  };

  static std::uint64_t range(std::int64_t first, std::int64_t end) {
    return static_cast<std::uint64_t>(first) << 32U | static_cast<std::uint64_t>(end);
  }

  static Index take_from(Share& share, End side) {
    std::uint64_t seen = share.left.load(std::memory_order_relaxed);
    for (;;) {
      const auto first = static_cast<Index>(seen >> 32U), end = static_cast<Index>(seen & 0xFFFFFFFFU);
      if (first >= end) return -1;
      const std::uint64_t rest = side == End::first ? range(first + 1, end) : range(first, end - 1);
      if (share.left.compare_exchange_weak(seen, rest, std::memory_order_relaxed))
        return side == End::first ? first : end - 1;
    }
  }

  std::vector<Share> shares_;
};

}  // namespace stiv
