// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/contact_planes.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "acceptance/intersection/near_pairs.hpp"
#include "editing/flush_triangles.hpp"

namespace stiv {

namespace {

constexpr std::size_t most_pairs = 100'000;        // of all contacts
constexpr std::size_t most_pairs_of_two = 10'000;  // of one contact
constexpr std::size_t most_planes = 64;            // of two parts: a curved contact has one for each triangle

/// A plane in which triangles of two parts lie on each other.
struct Plane {
  Vector3 point, normal;
  double tolerance;

  bool contains(const Triangles& triangles, Index triangle, const PositionsView& q) const {
    const Corners corners = corners_of(triangles, triangle, q);
    return std::all_of(corners.begin(), corners.end(),
                       [&](const Vector3& corner) { return std::abs(normal.dot(corner - point)) <= tolerance; });
  }
};

/// The plane of the larger one of two triangles, if they lie on each other.
std::optional<Plane> common_plane(const Triangles& triangles, Index a, Index b, const PositionsView& q,
                                  double tolerance) {
  Vector3 first = area_normal_of(corners_of(triangles, a, q)), second = area_normal_of(corners_of(triangles, b, q));
  if (first.norm() < second.norm()) {
    std::swap(a, b);
    std::swap(first, second);
  }
  const Plane plane{q.row(triangles(a, 0)), first.normalized(), tolerance};
  const bool faces = std::abs(plane.normal.dot(second)) >= least_flush_cosine * second.norm();
  return faces && plane.contains(triangles, b, q) ? std::optional(plane) : std::nullopt;
}

/// Triangles of one part in that plane, and neighbors that leave it.
struct Region {
  std::set<Index> inside, outside;
  std::vector<Index> last;  // inside, their neighbors not yet examined

  void add(Index triangle) {
    if (inside.insert(triangle).second) last.push_back(triangle);
  }
};

/// Two parts that lie on each other in one plane.
struct Contact {
  Plane plane;
  Region first, second;

  bool is_complete() const { return first.last.empty() && second.last.empty(); }

  std::size_t pair_count() const {
    return first.inside.size() * (second.inside.size() + second.outside.size()) +
           first.outside.size() * second.inside.size();
  }
};

/// Adds the neighbors of the triangles that were added last.
void grow(Region& region, const Plane& plane, const Triangles& triangles, const std::vector<std::vector<Index>>& around,
          const PositionsView& q) {
  std::vector<Index> last;
  std::swap(last, region.last);
  for (const Index triangle : last)
    for (int k = 0; k < 3; ++k)
      for (const Index neighbor : around[at(triangles(triangle, k))])
        if (plane.contains(triangles, neighbor, q))
          region.add(neighbor);
        else
          region.outside.insert(neighbor);
}

using Contacts = std::map<std::pair<Index, Index>, std::vector<Contact>>;

/// The planes of contact of each two parts, smaller name first, and the triangles that touch there.
Contacts contacts_of(const Triangles& triangles, const SurfaceParts& parts, const IndexPairs& flush,
                     const PositionsView& q, double tolerance) {
  Contacts found;
  for (auto [a, b] : flush) {
    if (parts.of(a) > parts.of(b)) std::swap(a, b);
    const auto plane = common_plane(triangles, a, b, q, tolerance);
    if (!plane) continue;
    std::vector<Contact>& contacts = found[{parts.of(a), parts.of(b)}];
    auto contact = std::find_if(contacts.begin(), contacts.end(), [&](const Contact& each) {
      return each.plane.contains(triangles, a, q) && each.plane.contains(triangles, b, q);
    });
    if (contact == contacts.end()) {
      if (contacts.size() == most_planes) continue;
      contact = contacts.insert(contacts.end(), {*plane, {}, {}});
    }
    contact->first.add(a);
    contact->second.add(b);
  }
  return found;
}

void insert_pairs(IndexPairs& pairs, const std::set<Index>& first, const std::set<Index>& second) {
  for (const Index a : first)
    for (const Index b : second) pairs.push_back(std::minmax(a, b));
}

/// Sorts pairs, and removes those of a sorted list.
void keep_new(IndexPairs& pairs, const IndexPairs& known) {
  sort_unique(pairs);
  std::erase_if(pairs, [&](const auto& pair) { return std::binary_search(known.begin(), known.end(), pair); });
}

}  // namespace

PairsInContactPlanes find_in_contact_planes(const Surface& surface, const SurfaceParts& parts, const IndexPairs& flush,
                                            const std::vector<std::vector<Index>>& around, const PositionsView& start,
                                            double rounding) {
  const Triangles& triangles = surface.triangles();
  Contacts contacts = contacts_of(triangles, parts, flush, start, 2 * rounding);
  std::size_t count = 0;
  for (const auto& [names, of_two] : contacts) count += of_two.size();
  const std::size_t most = count > 0 ? std::min(most_pairs_of_two, most_pairs / count) : 0;
  PairsInContactPlanes found;
  for (auto& [names, of_two] : contacts)
    for (Contact& contact : of_two) {
      while (!contact.is_complete()) {
        Contact larger = contact;
        grow(larger.first, larger.plane, triangles, around, start);
        grow(larger.second, larger.plane, triangles, around, start);
        if (larger.pair_count() > most) break;
        contact = std::move(larger);
      }
      insert_pairs(found.facing, contact.first.inside, contact.second.inside);
      insert_pairs(found.beside, contact.first.inside, contact.second.outside);
      insert_pairs(found.beside, contact.first.outside, contact.second.inside);
    }
  keep_new(found.facing, flush);
  keep_new(found.beside, flush);
  return found;
}

}  // namespace stiv
