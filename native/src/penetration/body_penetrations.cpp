// SPDX-License-Identifier: GPL-3.0-or-later
#include "penetration/body_penetrations.hpp"

#include <algorithm>

#include "penetration/body_components.hpp"

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

BodyPenetrations::BodyPenetrations(std::shared_ptr<const Surface> surface, double rounding)
    : surface_(std::move(surface)),
      rounding_(rounding),
      places_(static_cast<std::size_t>(surface_->triangles().rows())) {}

BodyPenetrations::BodyPenetrations(std::shared_ptr<const Surface> surface, const IndexPairs& excluded,
                                   const Positions& start, double rounding)
    : BodyPenetrations(std::move(surface), rounding) {
  for (const Index body : bodies_among(*surface_, excluded)) add_components(body, start);
  for (const auto& [a, b] : excluded) pairs_.push_back(ordered(place(a).component, place(b).component));
  std::sort(pairs_.begin(), pairs_.end());
  pairs_.erase(std::unique(pairs_.begin(), pairs_.end()), pairs_.end());
  std::erase_if(pairs_, [&](const auto& components) { return !is_measurable(components); });
}

BodyPenetrations BodyPenetrations::of_bodies(std::shared_ptr<const Surface> surface, const BodyPairs& bodies,
                                             const Positions& start, double rounding) {
  BodyPenetrations all(std::move(surface), rounding);
  for (Index body = 0; body < static_cast<Index>(all.surface_->bodies().size()); ++body)
    all.add_components(body, start);
  for (const auto& [a, b] : bodies)
    for (const Index first : {2 * a, 2 * a + 1})
      for (const Index second : {2 * b, 2 * b + 1})
        if (!all.component(first).mesh.triangles.empty() && !all.component(second).mesh.triangles.empty())
          all.pairs_.push_back(all.ordered(first, second));
  std::sort(all.pairs_.begin(), all.pairs_.end());
  all.pairs_.erase(std::unique(all.pairs_.begin(), all.pairs_.end()), all.pairs_.end());
  return all;
}

/// The open components of a body, then its closed ones.
void BodyPenetrations::add_components(Index body, const Positions& start) {
  BodyComponents components = body_components(*surface_, body);
  add_component(body, false, std::move(components.open), start);
  add_component(body, true, std::move(components.closed), start);
}

void BodyPenetrations::add_component(Index body, bool closed, std::vector<Index> triangles, const Positions& start) {
  const auto number = static_cast<Index>(components_.size());
  for (std::size_t k = 0; k < triangles.size(); ++k) places_[at(triangles[k])] = {number, static_cast<Index>(k)};
  Component& added =
      components_.emplace_back(Component{body, closed, body_mesh(*surface_, std::move(triangles)), {}, 1});
  const PlacedBody placed(added.mesh, start);
  added.start_areas = areas_of(placed);
  if (closed && placed.signed_volume() < 0) added.facing = -1;
}

/// An open component comes first.
std::array<Index, 2> BodyPenetrations::ordered(Index a, Index b) const {
  const bool forward = component(a).closed == component(b).closed ? a < b : component(b).closed;
  return forward ? std::array{a, b} : std::array{b, a};
}

bool BodyPenetrations::is_measurable(const std::array<Index, 2>& components) const {
  const Component &first = component(components[0]), &second = component(components[1]);
  return second.closed && first.body != second.body && surface_->bodies_meet(first.body, second.body);
}

std::vector<BodyPenetrations::Pair> BodyPenetrations::pairs() const {
  std::vector<Pair> pairs;
  for (const auto& [a, b] : pairs_)
    pairs.push_back({{component(a).body, component(b).body}, {component(a).closed, component(b).closed}});
  return pairs;
}

void BodyPenetrations::update(std::vector<Penetration>& penetrations, const std::vector<unsigned char>& displaced,
                              const Positions& q, const IndexPairs& intersecting) const {
  const std::vector<IndexPairs> candidates = pairs_of_components(intersecting);
  const auto is_displaced = [&](Index number) { return displaced[at(component(number).body)] != 0; };
  for (std::size_t k = 0; k < pairs_.size(); ++k)
    if (is_displaced(pairs_[k][0]) || is_displaced(pairs_[k][1]))
      penetrations[k] = measured(pairs_[k], candidates[k], q);
}

/// For each pair of components, the intersecting pairs of their triangles.
std::vector<IndexPairs> BodyPenetrations::pairs_of_components(const IndexPairs& intersecting) const {
  std::vector<IndexPairs> candidates(pairs_.size());
  for (const auto& [a, b] : intersecting) {
    Place first = place(a), second = place(b);
    if (first.component < 0 || second.component < 0) continue;
    const std::array<Index, 2> components = ordered(first.component, second.component);
    const auto found = std::lower_bound(pairs_.begin(), pairs_.end(), components);
    if (found == pairs_.end() || *found != components) continue;
    if (first.component != components[0]) std::swap(first, second);
    candidates[at(found - pairs_.begin())].emplace_back(first.triangle, second.triangle);
  }
  return candidates;
}

Penetration BodyPenetrations::measured(const std::array<Index, 2>& components, const IndexPairs& candidates,
                                       const Positions& q) const {
  const Component &a = component(components[0]), &b = component(components[1]);
  const PlacedBody first(a.mesh, q), second(b.mesh, q);
  if (!b.closed) return intersection_length(first, second, candidates, rounding_);
  Penetration found = a.closed ? common_volume(first, second, candidates, rounding_)
                               : area_inside(first, a.start_areas, second, candidates, rounding_);
  found.amount *= a.facing * b.facing;
  return found;
}

}  // namespace stiv
