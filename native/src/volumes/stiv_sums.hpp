// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stiv/volumes/relative.hpp"

namespace stiv {

/// Sums the volumes and gradients of regions by patch.
class StivSums {
 public:
  /// @param labels patch of each region, 0, 1, ...
  explicit StivSums(const std::vector<Index>& labels);

  void add_volume(Index patch, double volume) { stivs_[at(patch)].volume += volume; }
  void add_gradient(Index patch, Index vertex, const Vector3& value) { entries_.push_back({patch, vertex, value}); }

  /// The STIVs, one for each patch. Call once.
  std::vector<Stiv> stivs();

 private:
  struct Entry {
    Index patch, vertex;
    Vector3 value;
  };

  std::vector<Stiv> stivs_;
  std::vector<Entry> entries_;
};

}  // namespace stiv
