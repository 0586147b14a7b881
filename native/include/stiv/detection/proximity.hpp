// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <vector>

#include "stiv/types.hpp"

namespace stiv {

/// The separation of each pair of bodies; symmetric.
class BodySeparations {
 public:
  BodySeparations(std::size_t bodies, double separation) : bodies_(bodies), values_(bodies * bodies, separation) {}

  void set(Index a, Index b, double separation) { values_[place(a, b)] = values_[place(b, a)] = separation; }
  double between(Index a, Index b) const { return values_[place(a, b)]; }
  double largest() const { return values_.empty() ? 0 : *std::max_element(values_.begin(), values_.end()); }

 private:
  std::size_t place(Index a, Index b) const {
    return static_cast<std::size_t>(a) * bodies_ + static_cast<std::size_t>(b);
  }

  std::size_t bodies_;
  std::vector<double> values_;  // (bodies, bodies)
};

/// From when on two primitives count as interfering. [DESIGN 3, "Events at a distance"]
struct Proximity {
  double separation = 0;  ///< h >= 0, in the units of the positions; the largest one where they differ by bodies
  double keep = 0.5;      ///< in (0, 1): pairs that start nearer than h keep this fraction of their distance instead
  const BodySeparations* by_bodies = nullptr;  ///< null: h for all

  /// That of a pair of these bodies.
  Proximity between(Index a, Index b) const {
    return by_bodies == nullptr ? *this : Proximity{by_bodies->between(a, b), keep};
  }

  /// h_eff for a pair at distance d0 at the start of the step: h, but keep d0 for those that start nearer than h.
  double threshold(double start_distance) const {
    return starts_apart(separation, start_distance) ? separation : keep * start_distance;
  }

  /// The distance that the response aims for. Of pairs that start nearer than h it is their own, so that none jumps;
  /// of others more than h, which would be met again at once by what rounding takes from it.
  static double target(double separation, double start_distance) {
    if (!starts_apart(separation, start_distance)) return start_distance;
    return std::clamp(start_distance, 1.5 * separation, 2 * separation);
  }

 private:
  /// What has come as near as h keeps it, even where rounding has taken a little.
  static bool starts_apart(double separation, double start_distance) {
    return start_distance >= (1 - 0x1p-24) * separation;
  }
};

}  // namespace stiv
