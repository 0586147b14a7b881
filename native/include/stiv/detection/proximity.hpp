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

/// A set of pairs of bodies.
class BodyPairSet {
 public:
  explicit BodyPairSet(std::size_t bodies) : bodies_(bodies), values_(bodies * bodies, 0) {}

  void insert(Index a, Index b) { values_[place(a, b)] = values_[place(b, a)] = 1; }
  bool contains(Index a, Index b) const { return values_[place(a, b)] != 0; }

 private:
  std::size_t place(Index a, Index b) const {
    return static_cast<std::size_t>(a) * bodies_ + static_cast<std::size_t>(b);
  }

  std::size_t bodies_;
  std::vector<unsigned char> values_;  // (bodies, bodies)
};

/// Distances of a pair of primitives.
struct PairClearance {
  double threshold = 0;  ///< h_eff: the pair may not come nearer
  double margin = 0;     ///< how far beyond that it may be pushed, so that rounding causes no new contact
};

/// When two primitives interfere. (mathematics.md, "Separation")
struct Proximity {
  double separation = 0;  ///< h >= 0, in the units of the positions; the largest one where bodies differ
  /// In (0, 1). A pair nearer than h at the reference keeps this fraction of that distance.
  double min_clearance_ratio = 0.5;
  const BodySeparations* by_bodies = nullptr;  ///< null: h for all
  /// Positions, (N, 3), at which distances of pairs nearer than h are measured, such as the start of a session. Must
  /// outlive the step. Null: the start of the step.
  const Positions* reference = nullptr;
  double min_clearance_ratio_between = 0;          ///< the ratio for pairs of different bodies; 0: the same
  const BodyPairSet* without_reference = nullptr;  ///< pairs of bodies measured at the start of the step; null: none

  /// The proximity of a pair of these bodies.
  Proximity between(Index a, Index b) const {
    Proximity pair = *this;
    if (by_bodies != nullptr) pair.separation = by_bodies->between(a, b);
    if (without_reference != nullptr && without_reference->contains(a, b)) pair.reference = nullptr;
    if (a != b && min_clearance_ratio_between > 0) pair.min_clearance_ratio = min_clearance_ratio_between;
    return pair;
  }

  /// The clearance of a pair at this distance at the reference: h, or a fraction of that distance if it is nearer. It
  /// is not pushed beyond that distance, so that no pair jumps.
  PairClearance clearance(double reference_distance) const {
    if (is_apart(reference_distance)) return {separation, separation / 2};
    return {min_clearance_ratio * reference_distance, (1 - min_clearance_ratio) * reference_distance};
  }

  /// Pairs at h, within rounding, count as apart.
  bool is_apart(double distance) const { return distance >= (1 - 0x1p-24) * separation; }
};

}  // namespace stiv
