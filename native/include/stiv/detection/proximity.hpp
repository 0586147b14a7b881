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

/// What a pair of primitives keeps.
struct Keeping {
  double threshold = 0;  ///< h_eff, the distance that it may not come within
  double ease = 0;       ///< how far beyond that it may be pushed, so that what rounding takes is no new contact
};

/// From when on two primitives count as interfering. (mathematics.md, "Separation")
struct Proximity {
  double separation = 0;  ///< h >= 0, in the units of the positions; the largest one where they differ by bodies
  double keep = 0.5;      ///< in (0, 1): pairs nearer than h at the reference keep this fraction of that distance;
                          ///< those within a body, where keep_between is set
  const BodySeparations* by_bodies = nullptr;  ///< null: h for all
  /// Where pairs are measured that may be nearer than h, (N, 3), such as where a session began; it must outlive the
  /// step. Null: at the start of the step.
  const Positions* reference = nullptr;
  double keep_between = 0;  ///< the fraction for pairs of different bodies; 0: the same

  /// That of a pair of these bodies.
  Proximity between(Index a, Index b) const {
    Proximity pair = *this;
    if (by_bodies != nullptr) pair.separation = by_bodies->between(a, b);
    if (a != b && keep_between > 0) pair.keep = keep_between;
    return pair;
  }

  /// That of a pair at this distance at the reference: h, but if it is nearer there a fraction of that distance. It is
  /// pushed no farther than it was, so that none jumps.
  Keeping keeping(double reference_distance) const {
    if (is_apart(reference_distance)) return {separation, separation / 2};
    return {keep * reference_distance, (1 - keep) * reference_distance};
  }

  /// What has come as near as h keeps it, even where rounding has taken a little.
  bool is_apart(double distance) const { return distance >= (1 - 0x1p-24) * separation; }
};

}  // namespace stiv
