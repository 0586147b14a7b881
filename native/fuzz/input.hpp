// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <span>

#include "stiv/types.hpp"

namespace stiv::fuzz {

/// Input of the fuzzer, read piece by piece; zeros after its end.
class Input {
 public:
  Input(const std::uint8_t* data, std::size_t size) : bytes_(data, size) {}

  bool empty() const { return bytes_.empty(); }

  std::uint8_t byte() {
    if (bytes_.empty()) return 0;
    const std::uint8_t first = bytes_.front();
    bytes_ = bytes_.subspan(1);
    return first;
  }

  /// An integer in [0, count).
  Index below(Index count) { return byte() % count; }

  /// A coordinate: usually on a grid of sixteenths, where parallel, coplanar and touching primitives are frequent;
  /// otherwise a few units in the last place off the grid, or any number of moderate size.
  double coordinate(bool on_grid) {
    const auto steps = static_cast<std::int8_t>(byte());
    if (on_grid) return steps / 16.0;
    const std::uint8_t what = byte();
    const double value = steps / 16.0;
    if (what < 64) return value;
    if (what < 128) return value * (1 + (what - 96) * 0x1p-52);
    if (what < 192) return value + (what - 160) * 0x1p-30;
    return value * std::exp2((what - 224) / 4.0);
  }

  Vector3 point(bool on_grid) {
    const double x = coordinate(on_grid), y = coordinate(on_grid), z = coordinate(on_grid);
    return {x, y, z};
  }

  Positions positions(Index count, bool on_grid) {
    Positions q(count, 3);
    for (Index row = 0; row < count; ++row) q.row(row) = point(on_grid);
    return q;
  }

 private:
  std::span<const std::uint8_t> bytes_;
};

/// Ends the run; libFuzzer reports the input.
inline void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", what);
  std::abort();
}

}  // namespace stiv::fuzz
