// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <memory>
#include <optional>

#include "stiv/surface.hpp"

namespace stiv {

/// Where two triangles of a surface are nearest to each other.
struct NearestTriangles {
  double distance = 0;               ///< 0 where they intersect
  std::array<Index, 2> triangles{};  ///< smaller index first
  std::array<Vector3, 2> points{};   ///< on each of them; where they intersect, the nearest points of their borders
};

/// The least distance between triangles at rest, by a tree that is kept between calls. Pairs of bodies that do not meet
/// are left out. Loose edges and vertices do not count. Not for use from two threads at once.
class LeastDistance {
 public:
  explicit LeastDistance(std::shared_ptr<const Surface> surface);
  ~LeastDistance();
  LeastDistance(LeastDistance&&) noexcept;
  LeastDistance& operator=(LeastDistance&&) noexcept;

  /// At positions q, (N, 3); nothing if there is no pair. Of several pairs at the same distance always the same one.
  /// @param within also pairs of one body, but those that share a vertex
  std::optional<NearestTriangles> find(const PositionsView& q, bool within = false);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace stiv
