// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "acceptance/common_volume.hpp"

namespace stiv {

/// Keeps closed bodies of which pairs are excluded from going deeper into each other: the volume that two of them have
/// in common never exceeds that at the start of the session. Compared with the start and not with the state before, so
/// that what went out may come back as far, and rounding does not add up. (mathematics.md, "Excluded pairs")
class DepthWatch {
 public:
  /// @param excluded pairs of triangles that may intersect
  /// @param rounding how far storing may move a vertex
  DepthWatch(std::shared_ptr<const Surface> surface, const IndexPairs& excluded, double rounding)
      : volumes_(std::move(surface), excluded), rounding_(rounding) {}

  bool begun() const { return !at_start_.empty() || volumes_.empty(); }

  /// Takes the volumes at the start. Bodies that touch there without crossing are not watched.
  /// @param intersecting all pairs of triangles that intersect at q, sorted
  void begin(const Positions& q, const IndexPairs& intersecting) { at_start_ = volumes_.at(q, intersecting); }

  /// Is a watched volume larger than at the start, or not to be told since something touches?
  bool is_deeper(const Positions& q, const IndexPairs& intersecting) const;

 private:
  CommonVolumes volumes_;
  double rounding_;
  std::vector<std::optional<CommonVolume>> at_start_;
};

}  // namespace stiv
