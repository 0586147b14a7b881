// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "editing/surface_parts.hpp"
#include "penetration/body_mesh.hpp"
#include "stiv/acceptance/intersections.hpp"
#include "stiv/detection/event.hpp"
#include "stiv/surface.hpp"

namespace stiv {

/// The contact of two triangles at the start of a step: that of the corner of the first and the corner of the second
/// that overlap most along the normal at its end.
Event contact_along(const Vector3& normal, std::array<Index, 3> first, std::array<Index, 3> second,
                    const PositionsView& end);

/// Triangles of parts that only touch at the start, where they lie on each other. A part can pass the face of a closed
/// one without any two triangles that intersect: along its sides, such as a crate into one of the same size below it. A
/// triangle that touched the closed part then lies inside it, or outside if it was enclosed. (mathematics.md, "Excluded
/// pairs")
class FacingParts {
 public:
  FacingParts() = default;

  /// @param flush pairs of triangles of parts that only touch
  /// @param apart pairs of triangles of the same parts, in one plane, that do not touch
  /// @param rounding distances below it are rounding
  FacingParts(const Surface& surface, const SurfaceParts& parts, const IndexPairs& flush, const IndexPairs& apart,
              const PositionsView& start, double rounding);

  /// The first pair, smaller index first, of which one triangle has passed the other by more than `depth`.
  std::optional<std::pair<Index, Index>> find_passed(const PositionsView& q, double depth) const;

  /// A direction that parts two parts: from the second to the first.
  struct Parting {
    std::pair<Index, Index> parts;  ///< as SurfaceParts names them
    Vector3 direction;
  };

  /// Adds an event for each triangle that has passed by more than `depth` at the end of a step: the plane of the one
  /// that it touched, at the time at which it reaches that. Returns the normals of these planes.
  /// @param margin of the events
  std::vector<Parting> add_contacts(Events& events, const PositionsView& from, const PositionsView& to, double depth,
                                    double margin) const;

 private:
  struct Facing {
    Index face, base;               // triangles; that of the base belongs to a closed part
    std::pair<Index, Index> parts;  // of face and base, as SurfaceParts names them
    bool is_enclosed;               // is the part of the face within that of the base, such as a crate in a room?
  };
  /// A part of any facing triangle.
  struct Part {
    BodyMesh mesh;
    Eigen::AlignedBox3d box;  // at the start
    double side;              // on which its faces enclose it: -1 behind them, 1 in front
  };

  void find_parts(const Surface& surface, const SurfaceParts& parts, const IndexPairs& flush,
                  const PositionsView& start);
  std::optional<Facing> facing_of(Index face, Index base, const SurfaceParts& parts, const PositionsView& start,
                                  bool touch) const;
  Vector3 free_side(const Facing& facing, const PositionsView& q) const;
  std::optional<Vector3> point_below(const Facing& facing, const PositionsView& q, double depth) const;
  bool has_passed(const Facing& facing, const PositionsView& q, Vector3 point) const;

  Triangles triangles_;
  double rounding_ = 0;
  std::vector<Facing> facing_;
  std::map<Index, Part> parts_;  // by the name of SurfaceParts
};

}  // namespace stiv
