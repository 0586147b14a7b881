// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/broad_phase/group_frames.hpp"

namespace stiv {

namespace {

std::array<float, 6> range_of(const Vector3& motion) {
  std::array<float, 6> range{};
  Bounds bounds = Bounds::empty();
  bounds.include(motion, 0);
  const PackedBox box = PackedBox::of(bounds, false);
  for (std::size_t k = 0; k < 6; ++k)
    if (motion[static_cast<Index>(k % 3)] != 0) range[k] = box.values[k];
  return range;
}

}  // namespace

// Two sums in single precision are rounded: that of two displacements, and that of a box and its growth. Each errs by
// at most 2^-24 of its value, which is at most three times the reach.
GroupFrames::GroupFrames(std::span<const Vector3> motions, double reach) {
  const auto differs = [&](const Vector3& motion) { return motion != motions.front(); };
  if (std::none_of(motions.begin(), motions.end(), differs)) return;
  std::array<float, 6> all;
  all.fill(std::numeric_limits<float>::infinity());
  for (const Vector3& motion : motions) {
    ranges_.push_back(range_of(motion));
    for (std::size_t k = 0; k < 6; ++k) all[k] = std::min(all[k], ranges_.back()[k]);
  }
  ranges_.push_back(all);
  constexpr auto largest = static_cast<double>(std::numeric_limits<float>::max());
  rounding_ = static_cast<float>(std::min(0x1p-20 * reach, largest)) + std::numeric_limits<float>::min();
}

}  // namespace stiv
