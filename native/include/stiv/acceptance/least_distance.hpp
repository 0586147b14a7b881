// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <memory>
#include <optional>

#include "stiv/surface.hpp"

namespace stiv {

/// The closest points of two triangles of a surface.
struct NearestTriangles {
  double distance = 0;               ///< 0 if they intersect
  std::array<Index, 2> triangles{};  ///< smaller index first
  std::array<Vector3, 2> points{};   ///< on each of them; if they intersect, the closest points of their edges
};

/// The pairs of triangles whose distance counts.
enum class DistancePairs {
  between_bodies,  ///< those of different bodies
  all              ///< those within a body too, unless they share a vertex
};

/// The least distance between triangles at rest. It keeps a tree between calls, so it is not for use from two threads
/// at once. Pairs of bodies that do not meet are left out, and so are loose edges and vertices.
class LeastDistance {
 public:
  explicit LeastDistance(std::shared_ptr<const Surface> surface);
  ~LeastDistance();
  LeastDistance(LeastDistance&&) noexcept;
  LeastDistance& operator=(LeastDistance&&) noexcept;

  /// The closest pair at positions q, (N, 3), or nothing if there is no pair. The choice among equal distances depends
  /// on the input alone.
  /// @throws InputError as Surface::check_positions
  std::optional<NearestTriangles> find(const PositionsView& q, DistancePairs pairs = DistancePairs::between_bodies);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace stiv
