// SPDX-License-Identifier: GPL-3.0-or-later
#include "penetration/body_penetrations.hpp"

#include <algorithm>

#include "penetration/body_parts.hpp"

namespace stiv {

namespace {

/// The bodies of pairs of triangles, each once.
std::vector<Index> bodies_among(const Surface& surface, const IndexPairs& pairs) {
  std::vector<Index> bodies;
  for (const auto& [a, b] : pairs)
    for (const Index triangle : {a, b}) bodies.push_back(surface.body_of(surface.triangles()(triangle, 0)));
  std::sort(bodies.begin(), bodies.end());
  bodies.erase(std::unique(bodies.begin(), bodies.end()), bodies.end());
  return bodies;
}

std::vector<double> areas_of(const PlacedBody& body) {
  std::vector<double> areas;
  for (Index k = 0; k < body.triangle_count(); ++k) areas.push_back(body.area_vector(k).norm() / 2);
  return areas;
}

}  // namespace

BodyPenetrations::BodyPenetrations(std::shared_ptr<const Surface> surface, const IndexPairs& excluded,
                                   const Positions& start, double rounding)
    : surface_(std::move(surface)),
      rounding_(rounding),
      places_(static_cast<std::size_t>(surface_->triangles().rows())) {
  for (const Index body : bodies_among(*surface_, excluded)) add_parts(body, start);
  for (const auto& [a, b] : excluded) pairs_.push_back(ordered(place(a).part, place(b).part));
  std::sort(pairs_.begin(), pairs_.end());
  pairs_.erase(std::unique(pairs_.begin(), pairs_.end()), pairs_.end());
  std::erase_if(pairs_, [&](const auto& parts) { return !is_measurable(parts); });
}

void BodyPenetrations::add_parts(Index body, const Positions& start) {
  BodyParts parts = body_parts(*surface_, body);
  add_part(body, false, std::move(parts.open), start);
  add_part(body, true, std::move(parts.closed), start);
}

void BodyPenetrations::add_part(Index body, bool closed, std::vector<Index> triangles, const Positions& start) {
  const auto number = static_cast<Index>(parts_.size());
  for (std::size_t k = 0; k < triangles.size(); ++k) places_[at(triangles[k])] = {number, static_cast<Index>(k)};
  Part& added = parts_.emplace_back(Part{body, closed, body_mesh(*surface_, std::move(triangles)), {}, 1});
  const PlacedBody placed(added.mesh, start);
  added.start_areas = areas_of(placed);
  if (closed && placed.signed_volume() < 0) added.facing = -1;
}

/// Where one is open, it comes first.
std::array<Index, 2> BodyPenetrations::ordered(Index a, Index b) const {
  const bool forward = part(a).closed == part(b).closed ? a < b : part(b).closed;
  return forward ? std::array{a, b} : std::array{b, a};
}

bool BodyPenetrations::is_measurable(const std::array<Index, 2>& parts) const {
  const Part &first = part(parts[0]), &second = part(parts[1]);
  return second.closed && first.body != second.body && surface_->bodies_meet(first.body, second.body);
}

std::vector<BodyPenetrations::Pair> BodyPenetrations::pairs() const {
  std::vector<Pair> pairs;
  for (const auto& [a, b] : pairs_) pairs.push_back({{part(a).body, part(b).body}, {part(a).closed, part(b).closed}});
  return pairs;
}

void BodyPenetrations::update(std::vector<Penetration>& penetrations, const std::vector<unsigned char>& displaced,
                              const Positions& q, const IndexPairs& intersecting) const {
  const std::vector<IndexPairs> meeting = meeting_by_pair(intersecting);
  const auto is_displaced = [&](Index number) { return displaced[at(part(number).body)] != 0; };
  for (std::size_t k = 0; k < pairs_.size(); ++k)
    if (is_displaced(pairs_[k][0]) || is_displaced(pairs_[k][1])) penetrations[k] = measured(pairs_[k], meeting[k], q);
}

/// Of each pair, places of triangles in its first and its second part.
std::vector<IndexPairs> BodyPenetrations::meeting_by_pair(const IndexPairs& intersecting) const {
  std::vector<IndexPairs> meeting(pairs_.size());
  for (const auto& [a, b] : intersecting) {
    Place first = place(a), second = place(b);
    if (first.part < 0 || second.part < 0) continue;
    const std::array<Index, 2> parts = ordered(first.part, second.part);
    const auto found = std::lower_bound(pairs_.begin(), pairs_.end(), parts);
    if (found == pairs_.end() || *found != parts) continue;
    if (first.part != parts[0]) std::swap(first, second);
    meeting[at(found - pairs_.begin())].emplace_back(first.triangle, second.triangle);
  }
  return meeting;
}

Penetration BodyPenetrations::measured(const std::array<Index, 2>& parts, const IndexPairs& meeting,
                                       const Positions& q) const {
  const Part &a = part(parts[0]), &b = part(parts[1]);
  const PlacedBody first(a.mesh, q), second(b.mesh, q);
  Penetration found = a.closed ? common_volume(first, second, meeting, rounding_)
                               : area_inside(first, a.start_areas, second, meeting, rounding_);
  found.amount *= a.facing * b.facing;
  return found;
}

}  // namespace stiv
