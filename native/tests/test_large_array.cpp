// SPDX-License-Identifier: GPL-3.0-or-later
#include "large_array.hpp"

#include <doctest/doctest.h>

#include <cstdint>
#include <numeric>
#include <random>
#include <thread>

#include "stiv/types.hpp"

using namespace stiv;

namespace {

constexpr std::size_t large = 1 << 18;  // items, of 4 bytes each

}  // namespace

TEST_CASE("large array: the same items as a vector, through growth, copies and moves") {
  const MemoryReuse reuse;
  std::mt19937 random(1);
  LargeArray<Index> array;
  std::vector<Index> expected;
  for (std::size_t k = 0; k < large; ++k) {
    const auto item = static_cast<Index>(random() >> 1);
    array.push_back(item);
    expected.push_back(item);
  }
  const LargeArray<Index> copy = array, moved = std::move(array);
  CHECK(std::equal(copy.begin(), copy.end(), expected.begin(), expected.end()));
  CHECK(copy == moved);
  CHECK(LargeArray<Index>(large, 7) == LargeArray<Index>(large, 7));
}

TEST_CASE("large array: freed memory is used again, until no one keeps it") {
  CHECK(MemoryReuse::kept_bytes() == 0);
  {
    const MemoryReuse reuse;
    const Index* const memory = LargeArray<Index>(large).data();
    CHECK(MemoryReuse::kept_bytes() >= large * sizeof(Index));
    { const MemoryReuse other; }
    const LargeArray<Index> next(large - large / 20);
    CHECK(next.data() == memory);
    CHECK(MemoryReuse::kept_bytes() == 0);
  }
  {
    const MemoryReuse reuse;
    LargeArray<Index>{}.resize(large);
    CHECK(MemoryReuse::kept_bytes() > 0);
  }
  CHECK(MemoryReuse::kept_bytes() == 0);
  LargeArray<Index>{}.resize(large);
  CHECK(MemoryReuse::kept_bytes() == 0);
}

TEST_CASE("large array: small arrays are not kept, and blocks far larger than needed are not used") {
  const MemoryReuse reuse;
  LargeArray<Index>{}.resize(100);
  CHECK(MemoryReuse::kept_bytes() == 0);
  LargeArray<Index>{}.resize(large);
  const std::size_t kept = MemoryReuse::kept_bytes();
  const LargeArray<Index> quarter(large / 4);
  CHECK(MemoryReuse::kept_bytes() == kept);
}

TEST_CASE("large array: the kept memory has a limit") {
  const MemoryReuse reuse;
  constexpr std::size_t count = std::size_t{1} << 26;  // 256 MB, which no one writes
  { const LargeArray<Index> first(count), second(count); }
  CHECK(MemoryReuse::kept_bytes() < 2 * count * sizeof(Index));
  CHECK(MemoryReuse::kept_bytes() >= count * sizeof(Index));
}

TEST_CASE("large array: several threads share the memory") {
  const MemoryReuse reuse;
  const auto work = [](Index seed) {
    for (Index round = 0; round < 50; ++round) {
      LargeArray<Index> array(large / 8);
      std::iota(array.begin(), array.end(), seed);
      const LargeArray<Index> copy = array;
      CHECK(copy.back() == seed + static_cast<Index>(array.size()) - 1);
    }
  };
  std::thread other(work, 1);
  work(1 << 20);
  other.join();
}
