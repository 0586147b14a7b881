// SPDX-License-Identifier: GPL-3.0-or-later
#include "acceptance/body_penetrations.hpp"

#include <algorithm>

namespace stiv {

namespace {

Index body_of_triangle(const Surface& surface, Index triangle) {
  return surface.body_of(surface.triangles()(triangle, 0));
}

std::array<Index, 2> bodies_of(const Surface& surface, const std::pair<Index, Index>& pair) {
  const Index a = body_of_triangle(surface, pair.first), b = body_of_triangle(surface, pair.second);
  return {std::min(a, b), std::max(a, b)};
}

std::vector<std::array<Index, 2>> pairs_of_bodies(const Surface& surface, const IndexPairs& pairs) {
  std::vector<std::array<Index, 2>> bodies;
  for (const auto& pair : pairs) bodies.push_back(bodies_of(surface, pair));
  std::sort(bodies.begin(), bodies.end());
  bodies.erase(std::unique(bodies.begin(), bodies.end()), bodies.end());
  std::erase_if(bodies, [&](const auto& pair) { return pair[0] == pair[1] || !surface.bodies_meet(pair[0], pair[1]); });
  return bodies;
}

std::vector<double> areas_of(const PlacedBody& body) {
  std::vector<double> areas;
  for (Index k = 0; k < body.triangle_count(); ++k) areas.push_back(body.area_vector(k).norm() / 2);
  return areas;
}

Index place_in(const BodyMesh& mesh, Index triangle) {
  const auto found = std::lower_bound(mesh.triangles.begin(), mesh.triangles.end(), triangle);
  return static_cast<Index>(found - mesh.triangles.begin());
}

}  // namespace

BodyPenetrations::BodyPenetrations(std::shared_ptr<const Surface> surface, const IndexPairs& pairs,
                                   const Positions& start, double rounding)
    : surface_(std::move(surface)), rounding_(rounding), pairs_(pairs_of_bodies(*surface_, pairs)) {
  for (const auto& pair : pairs_)
    for (const Index body : pair)
      if (watched_.count(body) == 0) watched_.emplace(body, Watched{body_mesh(*surface_, body), {}, 1});
  std::erase_if(pairs_,
                [&](const auto& p) { return !watched_.at(p[0]).mesh.closed && !watched_.at(p[1]).mesh.closed; });
  for (auto& [body, watched] : watched_) {
    const PlacedBody placed(watched.mesh, start);
    watched.start_areas = areas_of(placed);
    if (watched.mesh.closed && placed.signed_volume() < 0) watched.facing = -1;
  }
}

void BodyPenetrations::update(std::vector<Penetration>& penetrations, const std::vector<unsigned char>& displaced,
                              const Positions& q, const IndexPairs& intersecting) const {
  std::vector<IndexPairs> meeting = meeting_by_pair(intersecting);
  const auto is_displaced = [&](Index body) { return displaced[static_cast<std::size_t>(body)] != 0; };
  for (std::size_t k = 0; k < pairs_.size(); ++k)
    if (is_displaced(pairs_[k][0]) || is_displaced(pairs_[k][1]))
      penetrations[k] = measured(pairs_[k], std::move(meeting[k]), q);
}

/// Of each pair of bodies, places of their triangles in its first and its second body.
std::vector<IndexPairs> BodyPenetrations::meeting_by_pair(const IndexPairs& intersecting) const {
  std::vector<IndexPairs> meeting(pairs_.size());
  for (auto [a, b] : intersecting) {
    const std::array<Index, 2> bodies = bodies_of(*surface_, {a, b});
    const auto found = std::lower_bound(pairs_.begin(), pairs_.end(), bodies);
    if (found == pairs_.end() || *found != bodies) continue;
    if (body_of_triangle(*surface_, a) != bodies[0]) std::swap(a, b);
    meeting[static_cast<std::size_t>(found - pairs_.begin())].emplace_back(place_in(watched_.at(bodies[0]).mesh, a),
                                                                           place_in(watched_.at(bodies[1]).mesh, b));
  }
  return meeting;
}

Penetration BodyPenetrations::measured(const std::array<Index, 2>& bodies, IndexPairs meeting,
                                       const Positions& q) const {
  const Watched &a = watched_.at(bodies[0]), &b = watched_.at(bodies[1]);
  const PlacedBody first(a.mesh, q), second(b.mesh, q);
  Penetration found;
  if (a.mesh.closed && b.mesh.closed) {
    found = common_volume(first, second, meeting, rounding_);
  } else if (b.mesh.closed) {
    found = area_inside(first, a.start_areas, second, meeting, rounding_);
  } else {
    for (auto& [of_first, of_second] : meeting) std::swap(of_first, of_second);
    found = area_inside(second, b.start_areas, first, meeting, rounding_);
  }
  found.amount *= a.facing * b.facing;
  return found;
}

}  // namespace stiv
