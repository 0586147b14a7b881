// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/volumes/region.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

namespace stiv {

namespace {

/// A normal is usable if the two sides approach each other along it. At a smaller cosine they slide, and the sign of n
/// . Drho is rounding. (mathematics.md, "Regions")
constexpr double least_cosine = 1e-8;

template <class Field>
bool normal_is_usable(const Event& event, const Field& displacement) {
  const Vector3 relative = weighted_sum(event, displacement);
  return event.normal.dot(relative) < -least_cosine * relative.norm();
}

/// A contact within this weight of a vertex or edge of its face, or of an end of its edge, is a contact with that
/// vertex or edge, whose normal is arbitrary inside a flat wall. So is the normal of edges whose sine is below this.
/// Both would push a box along the wall that it lies on.
constexpr double least_weight = 1e-6;
constexpr double least_sine = 1e-3;

bool normal_is_stable(const Event& event, const Positions& start, const Positions& end) {
  if (event.is_plane) return true;
  for (const double weight : event.weights)
    if (std::abs(weight) < least_weight) return false;
  if (event.kind == EventKind::vertex_face) return true;
  const auto contact_corner = [&](int k) -> Vector3 {
    const Index vertex = event.vertices[k];
    return start.row(vertex) + event.time * (end.row(vertex) - start.row(vertex));
  };
  const Vector3 first = contact_corner(1) - contact_corner(0), second = contact_corner(3) - contact_corner(2);
  return first.cross(second).norm() > least_sine * first.norm() * second.norm();
}

/// Events with usable and stable normals; those with usable ones if none is stable.
std::vector<Index> response_events(const Events& events, const Positions& start, const Positions& end) {
  const auto displacement = end - start;  // lazy: evaluated at few vertices
  std::vector<Index> usable, stable;
  for (Index k = 0; k < static_cast<Index>(events.size()); ++k) {
    if (!normal_is_usable(events[k], displacement)) continue;
    usable.push_back(k);
    if (normal_is_stable(events[k], start, end)) stable.push_back(k);
  }
  return stable.empty() ? usable : stable;
}

/// The vertex of corners [begin, end) whose barycentric cell contains the contact; the first of equals.
Index heaviest_vertex(const Event& event, int begin, int end) {
  int heaviest = begin;
  for (int k = begin + 1; k < end; ++k)
    if (std::abs(event.weights[k]) > std::abs(event.weights[heaviest])) heaviest = k;
  return event.vertices[heaviest];
}

using BodyPair = std::pair<Index, Index>;

BodyPair bodies_of(const Surface& surface, const Event& event) {
  return {surface.body_of(event.vertices[0]), surface.body_of(event.vertices[first_side_size(event.kind)])};
}

bool is_rigid(const Surface& surface, const BodyPair& pair) {
  const auto rigid = [&](Index body) { return surface.bodies()[body].mobility == Mobility::rigid; };
  return rigid(pair.first) || rigid(pair.second);
}

/// Fraction of the remaining time after a rigid body's first contact in which further contacts count as simultaneous.
constexpr double rigid_window = 0.03;
constexpr std::size_t most_rigid_regions = 32;

/// Removes events of rigid bodies later than their pair's earliest ones.
std::vector<Index> without_consequences(const Surface& surface, const Events& events,
                                        const std::vector<Index>& chosen) {
  std::map<BodyPair, double> first;
  for (const Index k : chosen) {
    const auto entry = first.emplace(bodies_of(surface, events[k]), events[k].time).first;
    entry->second = std::min(entry->second, events[k].time);
  }
  std::vector<Index> kept;
  for (const Index k : chosen) {
    const BodyPair pair = bodies_of(surface, events[k]);
    const double latest = first[pair] + rigid_window * (1 - first[pair]);
    if (!is_rigid(surface, pair) || events[k].time <= latest) kept.push_back(k);
  }
  return kept;
}

/// Bounds the number of regions for each pair with a rigid body by keeping every n-th.
std::vector<Region> thinned(const Surface& surface, const Events& events, const std::vector<Region>& regions) {
  std::map<BodyPair, std::size_t> count, seen;
  for (const Region& region : regions)
    if (region.rigid) ++count[bodies_of(surface, events[region.event])];
  std::vector<Region> kept;
  for (const Region& region : regions) {
    const BodyPair pair = bodies_of(surface, events[region.event]);
    const std::size_t stride = (count[pair] + most_rigid_regions - 1) / most_rigid_regions;
    if (!region.rigid || seen[pair]++ % stride == 0) kept.push_back(region);
  }
  return kept;
}

/// The regions on both sides of the chosen events; for each vertex the earliest, the first of equals.
std::vector<Region> earliest_of(const Surface& surface, const Events& events, const std::vector<Index>& chosen) {
  std::vector<Index> region_of_vertex(at(surface.vertex_count()), -1);
  std::vector<Region> regions;
  const auto add = [&](Index vertex, Index event, bool rigid) {
    Index& known = region_of_vertex[at(vertex)];
    if (known < 0) {
      known = static_cast<Index>(regions.size());
      regions.push_back({vertex, event, rigid});
    } else if (Region& region = regions[at(known)];
               std::tie(events[event].time, event) < std::tie(events[region.event].time, region.event)) {
      region = {vertex, event, rigid};
    }
  };
  for (const Index k : chosen) {
    const Event& event = events[k];
    const int split = first_side_size(event.kind);
    const bool rigid = is_rigid(surface, bodies_of(surface, event));
    add(heaviest_vertex(event, 0, split), k, rigid);
    add(heaviest_vertex(event, split, 4), k, rigid);
  }
  std::sort(regions.begin(), regions.end(), [](const Region& a, const Region& b) { return a.vertex < b.vertex; });
  return thinned(surface, events, regions);
}

}  // namespace

std::vector<Region> earliest_regions(const Surface& surface, const Events& events, const Positions& start,
                                     const Positions& end) {
  return earliest_of(surface, events, without_consequences(surface, events, response_events(events, start, end)));
}

std::vector<Region> contact_regions(const Surface& surface, const Events& events, const Positions& start,
                                    const Positions& end) {
  std::vector<Index> of_rigid_bodies, others;
  for (const Index k : without_consequences(surface, events, response_events(events, start, end)))
    (is_rigid(surface, bodies_of(surface, events[k])) ? of_rigid_bodies : others).push_back(k);
  std::vector<Region> regions = earliest_of(surface, events, of_rigid_bodies);
  for (const Index k : others)
    regions.push_back({heaviest_vertex(events[k], 0, first_side_size(events[k].kind)), k, false});
  return regions;
}

}  // namespace stiv
