// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/broad_phase/curve_places.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detection/broad_phase/curve_places.cpp"
#include "vector/foreach_target.hpp"

#include "vector/dispatch.hpp"

HWY_BEFORE_NAMESPACE();
namespace stiv::HWY_NAMESPACE {

/// Cells of some points, as arrays over the points: compilers turn the loops below into vector code.
struct Cells {
  static constexpr std::size_t capacity = 64;
  HWY_ALIGN std::uint32_t x[capacity], y[capacity], z[capacity];
};

/// Halves, because a difference may overflow.
HWY_INLINE std::uint32_t cell(float position, float low, float scale) {
  constexpr float last = curve_side - 1;
  const float place = (position / 2 - low / 2) * scale;
  return static_cast<std::uint32_t>(static_cast<std::int32_t>(place < last ? place : last));
}

HWY_INLINE void find_cells(const NumberedPoint* points, std::size_t count, const CellScale& scale, Cells& cells) {
  for (std::size_t k = 0; k < count; ++k) {
    cells.x[k] = cell(points[k].position[0], scale.low[0], scale.scale);
    cells.y[k] = cell(points[k].position[1], scale.low[1], scale.scale);
    cells.z[k] = cell(points[k].position[2], scale.low[2], scale.scale);
  }
}

/// All bits set if this bit is.
HWY_INLINE std::uint32_t mask_of(std::uint32_t value, unsigned bit) { return 0U - (value >> bit & 1U); }

/// Replaces the coordinates of cells with the transposed index of their place on the curve. [Skilling 2004]
HWY_INLINE void transpose(Cells& cells) {
  for (unsigned bit = curve_bits - 1; bit > 0; --bit) {
    const std::uint32_t lower = (1U << bit) - 1;
    for (std::size_t k = 0; k < Cells::capacity; ++k) {
      std::uint32_t a = cells.x[k], b = cells.y[k], c = cells.z[k];
      a ^= lower & mask_of(a, bit);
      const std::uint32_t flip_b = mask_of(b, bit), swap_b = (a ^ b) & lower & ~flip_b;
      a ^= (lower & flip_b) ^ swap_b;
      b ^= swap_b;
      const std::uint32_t flip_c = mask_of(c, bit), swap_c = (a ^ c) & lower & ~flip_c;
      cells.x[k] = a ^ (lower & flip_c) ^ swap_c;
      cells.y[k] = b;
      cells.z[k] = c ^ swap_c;
    }
  }
  for (std::size_t k = 0; k < Cells::capacity; ++k) {
    const std::uint32_t a = cells.x[k], b = cells.y[k] ^ a, c = cells.z[k] ^ b;
    std::uint32_t parity = c >> 1;  // each bit becomes the parity of the higher ones
    for (unsigned shift = 1; shift < curve_bits; shift *= 2) parity ^= parity >> shift;
    cells.x[k] = a ^ parity;
    cells.y[k] = b ^ parity;
    cells.z[k] = c ^ parity;
  }
}

/// Two zeros after each of ten bits.
HWY_INLINE std::uint32_t spread_bits(std::uint32_t value) {
  value = (value | value << 16) & 0x030000FFU;
  value = (value | value << 8) & 0x0300F00FU;
  value = (value | value << 4) & 0x030C30C3U;
  return (value | value << 2) & 0x09249249U;
}

void find_places(const NumberedPoint* points, std::size_t count, const CellScale& scale, CurveEntry* entries) {
  Cells cells = {};
  for (std::size_t begin = 0; begin < count; begin += Cells::capacity) {
    const std::size_t some = count - begin < Cells::capacity ? count - begin : Cells::capacity;
    find_cells(points + begin, some, scale, cells);
    transpose(cells);
    for (std::size_t k = 0; k < Cells::capacity; ++k)
      cells.x[k] = spread_bits(cells.x[k]) << 2 | spread_bits(cells.y[k]) << 1 | spread_bits(cells.z[k]);
    for (std::size_t k = 0; k < some; ++k) entries[begin + k] = {cells.x[k], static_cast<std::uint32_t>(begin + k)};
  }
}

}  // namespace stiv::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace stiv {

void find_places(std::span<const NumberedPoint> points, const CellScale& scale, CurveEntry* entries) {
  STIV_FOR_VECTOR_TARGET(find_places)(points.data(), points.size(), scale, entries);
}

}  // namespace stiv
#endif
