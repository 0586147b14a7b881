// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/excluded_pairs.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "acceptance/clearance/triangle_distance.hpp"
#include "acceptance/intersection/near_pairs.hpp"
#include "editing/contact_planes.hpp"
#include "editing/touching_pairs.hpp"
#include "stiv/detection/distance.hpp"
#include "stiv/error.hpp"

namespace stiv {

namespace {

IndexPairs checked(const IndexPairs& pairs, Index triangle_count) {
  IndexPairs ordered;
  for (const auto& [a, b] : pairs) {
    if (std::min(a, b) < 0 || std::max(a, b) >= triangle_count || a == b)
      throw InputError("exclude: (" + std::to_string(a) + ", " + std::to_string(b) + ") is not a pair of the " +
                       std::to_string(triangle_count) + " triangles");
    ordered.emplace_back(std::min(a, b), std::max(a, b));
  }
  sort_unique(ordered);
  return ordered;
}

bool is_among(const IndexPairs& pairs, Index a, Index b) {
  return std::binary_search(pairs.begin(), pairs.end(), std::pair(std::min(a, b), std::max(a, b)));
}

/// The triangles of a surface at rest.
struct PlacedTriangles {
  const Triangles& triangles;
  const PositionsView& q;

  std::array<Index, 3> corners(Index triangle) const {
    return {triangles(triangle, 0), triangles(triangle, 1), triangles(triangle, 2)};
  }

  Eigen::AlignedBox3d box(Index triangle) const {
    Eigen::AlignedBox3d box;
    for (const Index corner : corners(triangle)) box.extend(Vector3(q.row(corner)));
    return box;
  }

  /// Whether two triangles are apart, but nearer than a distance.
  bool touch(Index a, Index b, double nearest) const {
    const std::array<Index, 3> first = corners(a), second = corners(b);
    return least_triangle_distance(first, second, q) < nearest &&
           triangle_distance(first, second, q).distance < nearest && !triangles_intersect(first, second, q);
  }

  bool intersect(Index a, Index b) const { return triangles_intersect(corners(a), corners(b), q); }
  bool intersect_deeper(Index a, Index b, double depth) const {
    return stiv::intersect_deeper(corners(a), corners(b), q, depth);
  }

  bool overlap_in_plane(Index a, Index b, double tolerance) const {
    return stiv::overlap_in_plane(corners(a), corners(b), q, tolerance);
  }

  bool coincide(Index a, Index b) const {
    const auto sorted = [&](Index triangle) {
      std::array<std::array<double, 3>, 3> points;
      std::transform(triangles.row(triangle).begin(), triangles.row(triangle).end(), points.begin(), [&](Index corner) {
        return std::array{q(corner, 0), q(corner, 1), q(corner, 2)};
      });
      std::sort(points.begin(), points.end());
      return points;
    };
    return sorted(a) == sorted(b);
  }
};

/// Whether all corners of two triangles move by the same displacement, up to a tolerance.
bool move_together(const std::array<Index, 3>& first, const std::array<Index, 3>& second, const PositionsView& start,
                   const PositionsView& end, double tolerance) {
  const auto displacement = [&](Index vertex) -> Vector3 { return end.row(vertex) - start.row(vertex); };
  const Vector3 common = displacement(first[0]);
  const auto deviates = [&](Index vertex) {
    return (displacement(vertex) - common).squaredNorm() > tolerance * tolerance;
  };
  return std::none_of(first.begin(), first.end(), deviates) && std::none_of(second.begin(), second.end(), deviates);
}

/// Of the contacts in which the same vertex moves toward equal planes, the deepest one: where a vertex meets several
/// triangles of a flat face, the others add nothing.
Events deepest_of_each(const Events& contacts, const Positions& from, const Positions& to) {
  constexpr double same_direction = 0.9999;  // least cosine
  const auto motion = [&](const Event& contact, int k) {
    const Index vertex = contact.vertices[k];
    return std::abs(contact.normal.dot(Vector3(to.row(vertex) - from.row(vertex))));
  };
  const auto depth = [&](const Event& contact) { return -contact.normal.dot(weighted_sum(contact, to)); };
  std::map<Index, std::vector<std::size_t>> found;
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const Event& contact = contacts[k];
    std::vector<std::size_t>& own = found[contact.vertices[motion(contact, 0) < motion(contact, 1) ? 1 : 0]];
    const auto equal = std::find_if(own.begin(), own.end(), [&](std::size_t other) {
      return std::abs(contacts[other].normal.dot(contact.normal)) > same_direction;
    });
    if (equal == own.end())
      own.push_back(k);
    else if (depth(contact) > depth(contacts[*equal]))
      *equal = k;
  }
  std::vector<std::size_t> kept;
  for (const auto& [vertex, own] : found) kept.insert(kept.end(), own.begin(), own.end());
  std::sort(kept.begin(), kept.end());
  Events deepest;
  for (const std::size_t k : kept) deepest.push_back(contacts[k]);
  return deepest;
}

}  // namespace

ExcludedPairs::ExcludedPairs(std::shared_ptr<const Surface> surface, const Given& given, const PositionsView& start,
                             double least, Execution& execution)
    : surface_(std::move(surface)), least_(least), rounding_(4 * least) {
  const IndexPairs pairs = checked(given.pairs, static_cast<Index>(surface_->triangles().rows()));
  bodies_ = bodies_of(pairs);
  divide_given(pairs, start);
  pairs_ = pairs;
  const IndexPairs contacts = contacts_of(given, start, execution);
  rounding_ = rounding_of(contacts, start);
  std::optional<SurfaceParts> parts;
  if (!contacts.empty() || (!given.parts_may_cut && !shallow_.empty())) {
    parts.emplace(*surface_);
    if (!given.parts_may_cut) take_flush(*parts, start);
    take_contacts(contacts, *parts, start);
  }
  if (pairs_.empty() && flush_.empty()) return;
  list_triangles_around_vertices();
  if (!flush_.empty()) take_contact_planes(given, *parts, start);
  add_touching(start);
  find_others_that_touch(start, execution);
}

/// The rounding of the contacts at the start: up to four times that of the coordinates, which may have been larger in
/// an edit before.
double ExcludedPairs::rounding_of(const IndexPairs& contacts, const PositionsView& start) const {
  const PlacedTriangles placed{surface_->triangles(), start};
  double deepest = 0, found = rounding_;
  for (const auto& [a, b] : contacts)
    if (const double depth = intersection_depth(placed.corners(a), placed.corners(b), start); depth < 4 * rounding_)
      deepest = std::max(deepest, depth);
  while (found <= deepest) found *= 2;
  return found;
}

void ExcludedPairs::list_triangles_around_vertices() {
  around_.resize(static_cast<std::size_t>(surface_->vertex_count()));
  const Triangles& triangles = surface_->triangles();
  for (Index triangle = 0; triangle < static_cast<Index>(triangles.rows()); ++triangle)
    for (int corner = 0; corner < 3; ++corner) {
      std::vector<Index>& around = around_[triangles(triangle, corner)];
      if (around.empty() || around.back() != triangle)
        around.push_back(triangle);  // once, even if the triangle is degenerate
    }
}

/// Divides the given pairs by their depth.
void ExcludedPairs::divide_given(const IndexPairs& pairs, const PositionsView& start) {
  const PlacedTriangles placed{surface_->triangles(), start};
  for (const auto& pair : pairs)
    if (placed.intersect(pair.first, pair.second))
      (placed.intersect_deeper(pair.first, pair.second, rounding()) ? deep_ : shallow_).push_back(pair);
}

/// Takes the shallow pairs of parts that only touch.
void ExcludedPairs::take_flush(const SurfaceParts& parts, const PositionsView& start) {
  IndexPairs cutting;
  for (const auto& pair : deep_) cutting.push_back(parts.of(pair));
  for (const auto& pair : pairs_inside(shallow_, parts, start)) cutting.push_back(parts.of(pair));
  sort_unique(cutting);
  const auto is_flush = [&](const std::pair<Index, Index>& pair) {
    return parts.are_of_one_body(pair) && !std::binary_search(cutting.begin(), cutting.end(), parts.of(pair));
  };
  std::copy_if(shallow_.begin(), shallow_.end(), std::back_inserter(flush_), is_flush);
  std::erase_if(shallow_, is_flush);
  std::erase_if(pairs_, [&](const auto& pair) { return is_among(flush_, pair.first, pair.second); });
}

/// The pairs of triangles, of bodies that may touch, that intersect or touch.
IndexPairs ExcludedPairs::contacts_of(const Given& given, const PositionsView& start, Execution& execution) const {
  IndexPairs bodies = bodies_within_reach(*surface_, given.touching, start, rounding());
  std::erase_if(bodies, [&](const auto& pair) { return is_among(given.overlapping, pair.first, pair.second); });
  return find_contacts(surface_, bodies, start, rounding(), execution);
}

/// Takes the contacts of parts that only touch. One of both is closed: of two sheets, none would be guarded by the
/// faces on its other side.
void ExcludedPairs::take_contacts(const IndexPairs& contacts, const SurfaceParts& parts, const PositionsView& start) {
  const PlacedTriangles placed{surface_->triangles(), start};
  IndexPairs cutting;
  for (const auto& pair : contacts)
    if (parts.closed_count(pair) == 0 || placed.intersect_deeper(pair.first, pair.second, rounding()))
      cutting.push_back(parts.of(pair));
  for (const auto& pair : pairs_inside(contacts, parts, start)) cutting.push_back(parts.of(pair));
  sort_unique(cutting);
  std::copy_if(contacts.begin(), contacts.end(), std::back_inserter(flush_),
               [&](const auto& pair) { return !std::binary_search(cutting.begin(), cutting.end(), parts.of(pair)); });
  std::sort(flush_.begin(), flush_.end());
}

/// Takes the pairs in the planes of contacts, too, where bodies keep no distance: an edge or a corner in that plane
/// would otherwise stop at faces that it reaches later.
void ExcludedPairs::take_contact_planes(const Given& given, const SurfaceParts& parts, const PositionsView& start) {
  IndexPairs sliding;
  std::copy_if(flush_.begin(), flush_.end(), std::back_inserter(sliding), [&](const auto& pair) {
    const auto body = [&](Index triangle) { return surface_->body_of(surface_->triangles()(triangle, 0)); };
    return given.separation(body(pair.first), body(pair.second)) <= rounding();
  });
  PairsInContactPlanes found = find_in_contact_planes(*surface_, parts, sliding, around_, start, rounding());
  const auto is_excluded = [&](const auto& pair) { return is_among(pairs_, pair.first, pair.second); };
  std::erase_if(found.facing, is_excluded);
  std::erase_if(found.beside, is_excluded);
  facing_ = FacingParts(*surface_, parts, flush_, found.facing, start, rounding());
  flush_.insert(flush_.end(), found.facing.begin(), found.facing.end());
  flush_.insert(flush_.end(), found.beside.begin(), found.beside.end());
  sort_unique(flush_);
  for (const auto& [a, b] : flush_) flush_parts_.emplace_back(parts.of(a), parts.of(b));
}

/// The pairs in one plane with the insides of both parts on the same side of it: these lie in each other, such as a
/// mirrored copy in place of the original. Without an inside, only equal triangles do.
IndexPairs ExcludedPairs::pairs_inside(const IndexPairs& pairs, const SurfaceParts& parts,
                                       const PositionsView& start) const {
  const PlacedTriangles placed{surface_->triangles(), start};
  IndexPairs found;
  std::copy_if(pairs.begin(), pairs.end(), std::back_inserter(found),
               [&](const auto& pair) { return placed.overlap_in_plane(pair.first, pair.second, rounding()); });
  std::erase_if(found, [&](const auto& pair) {
    return parts.closed_count(pair) < 2 && !placed.coincide(pair.first, pair.second);
  });
  return found;
}

void ExcludedPairs::add_touching(const PositionsView& start) {
  const PlacedTriangles placed{surface_->triangles(), start};
  const double reach = least_ * least_;
  IndexPairs near;
  for (const auto& [a, b] : pairs_) {
    const std::vector<Index> others = with_neighbors(b);
    for (const Index first : with_neighbors(a)) {
      const Eigen::AlignedBox3d box = placed.box(first);
      for (const Index second : others)
        if (box.squaredExteriorDistance(placed.box(second)) < reach) near.push_back(std::minmax(first, second));
    }
  }
  sort_unique(near);
  std::erase_if(near, [&](const auto& pair) {
    const auto& [a, b] = pair;
    return is_among(pairs_, a, b) || share_corner(placed.corners(a), placed.corners(b)) || !placed.touch(a, b, least_);
  });
  const auto given = static_cast<std::ptrdiff_t>(pairs_.size());
  pairs_.insert(pairs_.end(), near.begin(), near.end());
  std::inplace_merge(pairs_.begin(), pairs_.begin() + given, pairs_.end());
}

/// A triangle and those that share a corner with it.
std::vector<Index> ExcludedPairs::with_neighbors(Index triangle) const {
  std::vector<Index> found;
  for (int corner = 0; corner < 3; ++corner) {
    const std::vector<Index>& around = around_[at(surface_->triangles()(triangle, corner))];
    found.insert(found.end(), around.begin(), around.end());
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

void ExcludedPairs::find_others_that_touch(const PositionsView& start, Execution& execution) {
  const IndexPairs found = find_touching(surface_, bodies_, start, rounding(), execution);
  shallow_only_ = flush_;
  std::set_difference(found.begin(), found.end(), pairs_.begin(), pairs_.end(), std::back_inserter(shallow_only_));
  std::sort(shallow_only_.begin(), shallow_only_.end());
  std::merge(pairs_.begin(), pairs_.end(), shallow_only_.begin(), shallow_only_.end(), std::back_inserter(all_));
}

/// Pairs of bodies, smaller index first, sorted.
IndexPairs ExcludedPairs::bodies_of(const IndexPairs& pairs) const {
  const auto body = [&](Index triangle) { return surface_->body_of(surface_->triangles()(triangle, 0)); };
  IndexPairs bodies;
  for (const auto& [a, b] : pairs) bodies.push_back(std::minmax(body(a), body(b)));
  sort_unique(bodies);
  return bodies;
}

std::vector<Index> ExcludedPairs::triangles_with(const Index* begin, const Index* end) const {
  std::vector<Index> common = around_[static_cast<std::size_t>(*begin)];
  for (const Index* vertex = begin + 1; vertex != end; ++vertex) {
    const std::vector<Index>& other = around_[static_cast<std::size_t>(*vertex)];
    std::erase_if(common, [&](Index triangle) { return !std::binary_search(other.begin(), other.end(), triangle); });
  }
  return common;
}

bool ExcludedPairs::covers(const Event& event, const PositionsView& start, const Step& step) const {
  const Index *const begin = event.vertices.data(), *const split = begin + first_side_size(event.kind);
  const std::vector<Index> first = triangles_with(begin, split),
                           second = triangles_with(split, begin + event.vertices.size());
  const auto touch_at = [&](const std::function<Vector3(Index)>& position) {
    Quadruple<double> points;
    std::transform(begin, begin + event.vertices.size(), points.begin(), position);
    return witness<double>(event.kind, points).distance < rounding();
  };
  if (first.empty() || second.empty()) {  // a loose edge or vertex
    const std::pair<Index, Index> bodies = std::minmax(surface_->body_of(*begin), surface_->body_of(*split));
    return std::binary_search(bodies_.begin(), bodies_.end(), bodies) &&
           touch_at([&](Index vertex) -> Vector3 { return start.row(vertex); }) && touch_at(step.to);
  }
  bool touch = false, only_touch = false;  // of other faces of a body, or of parts
  for (const Index a : first)
    for (const Index b : second) {
      if (is_among(pairs_, a, b)) continue;
      if (is_among(flush_, a, b))
        only_touch = true;
      else if (is_among(shallow_only_, a, b))
        touch = true;
      else
        return false;
    }
  return (!touch || touch_at(step.to)) && (!only_touch || stays_on_its_side(event, first, second, step));
}

/// Whether the two primitives of an event, of parts that only touch at the start, touch at the start of the step, or
/// are parted by a plane at its start and its end. Along the normal n of the plane, the most of the lower one minus the
/// least of the upper one is convex in time, so it parts them in between, too. Otherwise one may have passed the other.
bool ExcludedPairs::stays_on_its_side(const Event& event, const std::vector<Index>& first,
                                      const std::vector<Index>& second, const Step& step) const {
  if (event.start_distance <= rounding()) return true;  // the end of the step tells
  const auto part = [&](const Vector3& normal) {
    return overlap_along(event, normal, step.from) < rounding() && overlap_along(event, normal, step.to) < rounding();
  };
  for (const auto* triangles : {&first, &second})
    for (const Index triangle : *triangles)
      for (const auto* position : {&step.from, &step.to}) {
        const auto corner = [&](int k) { return (*position)(surface_->triangles()(triangle, k)); };
        const Vector3 normal = (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized();
        if (part(normal) || part(-normal)) return true;
      }
  return false;
}

/// How far the two primitives of an event overlap along a direction from the second to the first; negative if apart.
double ExcludedPairs::overlap_along(const Event& event, const Vector3& direction,
                                    const std::function<Vector3(Index)>& position) const {
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
  for (int k = 0; k < 4; ++k) {
    const double height = direction.dot(position(event.vertices[at(k)]));
    if (k < first_side_size(event.kind))
      lowest = std::min(lowest, height);
    else
      highest = std::max(highest, height);
  }
  return highest - lowest;
}

void ExcludedPairs::remove_from(Events& events, const PositionsView& start, const Step& step) const {
  if (!empty()) std::erase_if(events, [&](const Event& event) { return covers(event, start, step); });
}

void ExcludedPairs::add_contacts(Events& events, const Positions& from, const Positions& to) const {
  const PlacedTriangles before{surface_->triangles(), from}, after{surface_->triangles(), to};
  Events contacts;
  const auto partings = facing_.add_contacts(contacts, from, to, rounding() / 2, least_);
  for (std::size_t k = 0; k < flush_.size(); ++k) {
    const std::array<Index, 3> a = before.corners(flush_[k].first), b = before.corners(flush_[k].second);
    if (!after.box(flush_[k].first).intersects(after.box(flush_[k].second))) continue;
    if (move_together(a, b, from, to, rounding() / 4)) continue;
    if (!stiv::intersect_deeper(a, b, to, rounding() / 2)) continue;  // a margin to the depth that is not accepted
    const std::optional<Vector3> common = common_parting(partings, flush_parts_[k], a, b, from);
    const Vector3 normal = common ? *common : parting_direction(a, b, from, to, 2 * rounding());
    Event contact = contact_along(normal, a, b, to);
    contact.clearance.margin = least_;
    if (normal.dot(weighted_sum(contact, to) - weighted_sum(contact, from)) < 0) contacts.push_back(contact);
  }
  const Events deepest = deepest_of_each(contacts, from, to);
  events.insert(events.end(), deepest.begin(), deepest.end());
}

/// The direction in which faces of the same two parts are stopped, if it parts two triangles, too: any other one would
/// keep a part that is pressed against the other from sliding along it.
std::optional<Vector3> ExcludedPairs::common_parting(const std::vector<FacingParts::Parting>& partings,
                                                     const std::pair<Index, Index>& parts,
                                                     const std::array<Index, 3>& first,
                                                     const std::array<Index, 3>& second,
                                                     const PositionsView& from) const {
  for (const auto& [faces, direction] : partings) {
    Vector3 normal = faces == parts ? direction : Vector3(-direction);
    if (faces != parts && faces != std::pair(parts.second, parts.first)) continue;
    double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
    for (const Index vertex : first) lowest = std::min(lowest, normal.dot(from.row(vertex)));
    for (const Index vertex : second) highest = std::max(highest, normal.dot(from.row(vertex)));
    if (highest - lowest < 2 * rounding()) return normal;
  }
  return std::nullopt;
}

IndexPairs ExcludedPairs::others(const IndexPairs& pairs, const PositionsView& q) const {
  const PlacedTriangles placed{surface_->triangles(), q};
  IndexPairs left;
  std::set_difference(pairs.begin(), pairs.end(), pairs_.begin(), pairs_.end(), std::back_inserter(left));
  std::erase_if(left, [&](const auto& pair) {
    const auto& [a, b] = pair;
    return is_among(shallow_only_, a, b) && !placed.intersect_deeper(a, b, rounding());
  });
  if (const auto passed = facing_.find_passed(q, rounding())) left.push_back(*passed);
  return left;
}

IntersectionCount ExcludedPairs::count(const IndexPairs& pairs, const PositionsView& q) const {
  const PlacedTriangles placed{surface_->triangles(), q};
  IntersectionCount found;
  for (const auto& [a, b] : pairs) {
    if (is_among(shallow_only_, a, b)) continue;
    if (is_among(shallow_, a, b))
      ++found.shallow;
    else if (is_among(deep_, a, b) || placed.intersect_deeper(a, b, rounding()))
      ++found.deep;
  }
  return found;
}

bool ExcludedPairs::are_more(const IntersectionCount& now, const IntersectionCount& before) const {
  const std::size_t parted = shallow_.size() - now.shallow;
  return now.deep > before.deep + parted || now.deep > deep_.size() + parted;
}

}  // namespace stiv
