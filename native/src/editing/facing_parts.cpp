// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/facing_parts.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "editing/flush_triangles.hpp"
#include "penetration/winding_numbers.hpp"

namespace stiv {

namespace {

using Polygon = std::vector<Vector3>;

constexpr double same_direction = 0.999;  // least cosine

std::array<Index, 3> vertices_of(const Triangles& triangles, Index triangle) {
  return {triangles(triangle, 0), triangles(triangle, 1), triangles(triangle, 2)};
}

/// The part of a polygon in front of a plane through a point.
Polygon clipped(const Polygon& polygon, const Vector3& point, const Vector3& normal) {
  Polygon left;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vector3 &here = polygon[k], &next = polygon[(k + 1) % polygon.size()];
    const double height = normal.dot(here - point), next_height = normal.dot(next - point);
    if (height >= 0) left.push_back(here);
    if ((height < 0) != (next_height < 0)) left.push_back(here + height / (height - next_height) * (next - here));
  }
  return left;
}

/// The points of a face above or below a base: that of their prism.
Polygon over(const Corners& face, const Corners& base, const Vector3& normal) {
  Polygon polygon(face.begin(), face.end());
  for (std::size_t k = 0; k < 3 && !polygon.empty(); ++k)
    polygon = clipped(polygon, base[k], normal.cross(base[(k + 1) % 3] - base[k]));
  return polygon;
}

/// The centroid of a convex polygon; none if it is narrower than `width`.
std::optional<Vector3> centroid_of(const Polygon& polygon, double width) {
  double area = 0, perimeter = 0;
  Vector3 moment = Vector3::Zero();
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vector3 &here = polygon[k], &next = polygon[(k + 1) % polygon.size()];
    perimeter += (next - here).norm();
    const double part = (here - polygon[0]).cross(next - polygon[0]).norm() / 2;
    area += part;
    moment += part * (polygon[0] + here + next) / 3;
  }
  if (!(area > width * perimeter)) return std::nullopt;
  return moment / area;
}

}  // namespace

Event contact_along(const Vector3& normal, std::array<Index, 3> first, std::array<Index, 3> second,
                    const PositionsView& end) {
  const auto is_lower = [&](Index i, Index j) { return end.row(i).dot(normal) < end.row(j).dot(normal); };
  std::iter_swap(second.begin(), std::max_element(second.begin(), second.end(), is_lower));
  Event event;
  event.vertices = {*std::min_element(first.begin(), first.end(), is_lower), second[0], second[1], second[2]};
  event.weights = {1, -1, 0, 0};
  event.normal = normal;
  event.is_plane = true;
  return event;
}

FacingParts::FacingParts(const Surface& surface, const SurfaceParts& parts, const IndexPairs& flush,
                         const IndexPairs& apart, const PositionsView& start, double rounding)
    : triangles_(surface.triangles()), rounding_(rounding) {
  find_parts(surface, parts, flush, start);
  for (const auto& [pairs, touch] : {std::pair(&flush, true), std::pair(&apart, false)})
    for (const auto& [a, b] : *pairs)
      for (const auto& [face, base] : {std::pair(a, b), std::pair(b, a)})
        if (const auto facing = facing_of(face, base, parts, start, touch)) facing_.push_back(*facing);
}

void FacingParts::find_parts(const Surface& surface, const SurfaceParts& parts, const IndexPairs& flush,
                             const PositionsView& start) {
  std::map<Index, std::vector<Index>> triangles;
  for (const auto& [a, b] : flush)
    for (const Index triangle : {a, b}) triangles.try_emplace(parts.of(triangle));
  if (triangles.empty()) return;
  for (Index triangle = 0; triangle < static_cast<Index>(triangles_.rows()); ++triangle)
    if (const auto found = triangles.find(parts.of(triangle)); found != triangles.end() && parts.is_first(triangle))
      found->second.push_back(triangle);
  for (auto& [name, own] : triangles) {
    Part& part = parts_[name];
    part.mesh = body_mesh(surface, std::move(own));
    const PlacedBody placed(part.mesh, start);
    part.box = placed.box();
    part.side = placed.signed_volume() < 0 ? 1 : -1;
  }
}

/// Whether a face lies on a base at the start, or only in its plane if they do not touch.
std::optional<FacingParts::Facing> FacingParts::facing_of(Index face, Index base, const SurfaceParts& parts,
                                                          const PositionsView& start, bool touch) const {
  if (!parts.is_closed(base)) return std::nullopt;
  const Corners on_face = corners_of(triangles_, face, start), on_base = corners_of(triangles_, base, start);
  const Vector3 normal = normal_of(on_base);
  const double cosine = normal.dot(normal_of(on_face));
  if (std::abs(cosine) < least_flush_cosine) return std::nullopt;
  if (touch) {
    const auto middle = centroid_of(over(on_face, on_base, normal), rounding_);
    if (!middle || std::abs(normal.dot(*middle - on_base[0])) > 2 * rounding_) return std::nullopt;
  }
  const std::pair<Index, Index> both(parts.of(face), parts.of(base));
  const Part &own = parts_.at(both.first), &other = parts_.at(both.second);
  const Vector3 margin = Vector3::Constant(2 * rounding_);
  const bool is_within = Eigen::AlignedBox3d(other.box.min() - margin, other.box.max() + margin).contains(own.box);
  // Both parts enclose the same side of the faces. A sheet encloses none, but faces that look inward are those of a
  // room.
  const bool on_one_side = parts.is_closed(face) ? own.side * cosine * other.side > 0 : other.side > 0;
  return Facing{face, base, both, is_within && on_one_side};
}

/// The normal of the base, on the side on which the face touches it.
Vector3 FacingParts::free_side(const Facing& facing, const PositionsView& q) const {
  const double side = parts_.at(facing.parts.second).side;
  return (facing.is_enclosed ? side : -side) * normal_of(corners_of(triangles_, facing.base, q));
}

/// The middle of the part of a face above or below its base, if it is deeper than `depth` below.
std::optional<Vector3> FacingParts::point_below(const Facing& facing, const PositionsView& q, double depth) const {
  const Corners face = corners_of(triangles_, facing.face, q), base = corners_of(triangles_, facing.base, q);
  const Vector3 up = free_side(facing, q);
  const auto is_above = [&](const Vector3& point) { return up.dot(point - base[0]) >= -depth; };
  if (std::all_of(face.begin(), face.end(), is_above)) return std::nullopt;
  const std::optional<Vector3> middle = centroid_of(over(face, base, normal_of(base)), rounding_);
  return middle && !is_above(*middle) ? middle : std::nullopt;
}

/// Whether a point of a face, below its base, has left the side on which the face touched the part of the base.
bool FacingParts::has_passed(const Facing& facing, const PositionsView& q, Vector3 point) const {
  const Part& part = parts_.at(facing.parts.second);
  if (facing.parts.first == facing.parts.second)  // off its own part
    point -= part.side * rounding_ * normal_of(corners_of(triangles_, facing.face, q));
  return (winding_number(PlacedBody(part.mesh, q), point, 1) != 0) != facing.is_enclosed;
}

std::optional<std::pair<Index, Index>> FacingParts::find_passed(const PositionsView& q, double depth) const {
  for (const Facing& facing : facing_)
    if (const auto point = point_below(facing, q, depth); point && has_passed(facing, q, *point))
      return std::minmax({facing.face, facing.base});
  return std::nullopt;
}

std::vector<FacingParts::Parting> FacingParts::add_contacts(Events& events, const PositionsView& from,
                                                            const PositionsView& to, double depth,
                                                            double margin) const {
  std::vector<Parting> partings;
  for (const Facing& facing : facing_) {
    const std::optional<Vector3> end = point_below(facing, to, depth);
    if (!end) continue;
    const Corners face = corners_of(triangles_, facing.face, from), base = corners_of(triangles_, facing.base, from);
    const Vector3 normal = free_side(facing, from);
    const std::optional<Vector3> begin = centroid_of(over(face, base, normal_of(base)), rounding_);
    const double height = begin ? normal.dot(*begin - base[0]) : 0;
    const bool touches = begin && std::abs(height) <= 2 * rounding_;
    if (!touches && !has_passed(facing, to, *end)) continue;  // winding numbers take a while, and mostly are not needed
    Event contact =
        contact_along(normal, vertices_of(triangles_, facing.face), vertices_of(triangles_, facing.base), to);
    const double way = normal.dot(weighted_sum(contact, to) - weighted_sum(contact, from));
    if (way >= 0) continue;
    contact.start_distance = std::max(height, 0.0);
    contact.time = std::min(1.0, contact.start_distance / -way);
    contact.clearance.margin = margin;
    events.push_back(contact);
    const auto is_known = [&](const Parting& parting) {
      return parting.parts == facing.parts && parting.direction.dot(normal) > same_direction;
    };
    if (std::none_of(partings.begin(), partings.end(), is_known)) partings.push_back({facing.parts, normal});
  }
  return partings;
}

}  // namespace stiv
