// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/volumes/published.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "volumes/published_gradient.hpp"
#include "volumes/stiv_sums.hpp"

namespace stiv {

namespace {

/// A side of an event with the region that contains the contact.
struct Side {
  Region region;
  ContactSide contact;
};

Side side_of(const Events& events, Index number, int begin, int end, const Positions& displacement) {
  const Event& event = events[at(number)];
  Side side{{0, number, false}, {begin, end, Vector3::Zero()}};
  double heaviest = -1;
  for (int corner = begin; corner < end; ++corner) {
    const auto k = static_cast<std::size_t>(corner);
    const double weight = std::abs(event.weights[k]);
    side.contact.displacement += weight * displacement.row(event.vertices[k]).transpose();
    if (weight <= heaviest) continue;
    heaviest = weight;
    side.region.vertex = event.vertices[k];
  }
  return side;
}

/// The earliest side in each region, by vertex.
std::vector<Side> earliest_sides(const Events& events, const Positions& displacement) {
  std::vector<Side> sides;
  for (Index k = 0; k < static_cast<Index>(events.size()); ++k) {
    const int split = first_side_size(events[at(k)].kind);
    sides.push_back(side_of(events, k, 0, split, displacement));
    sides.push_back(side_of(events, k, split, 4, displacement));
  }
  const auto key = [&](const Side& side) {
    const Region& region = side.region;
    return std::make_tuple(region.vertex, events[at(region.event)].time, region.event);
  };
  std::sort(sides.begin(), sides.end(), [&](const Side& a, const Side& b) { return key(a) < key(b); });
  const auto same_region = [](const Side& a, const Side& b) { return a.region.vertex == b.region.vertex; };
  sides.erase(std::unique(sides.begin(), sides.end(), same_region), sides.end());
  std::erase_if(sides, [&](const Side& side) {
    return side.contact.displacement.dot(events[at(side.region.event)].normal) == 0;
  });
  return sides;
}

std::vector<Region> regions_of(const std::vector<Side>& sides) {
  std::vector<Region> regions;
  for (const Side& side : sides) regions.push_back(side.region);
  return regions;
}

}  // namespace

std::vector<Stiv> published_volumes(const Surface& surface, const Events& events, const Positions& start,
                                    const Positions& end, const Eigen::VectorXd& areas, ConstraintKind kind,
                                    PublishedGradient gradient) {
  const std::vector<Side> sides = earliest_sides(events, end - start);
  const std::vector<Index> labels = ring_labels(surface, regions_of(sides), kind);
  StivSums gathering(labels);
  for (std::size_t number = 0; number < sides.size(); ++number) {
    const Side& side = sides[number];
    const Event& event = events[at(side.region.event)];
    const double area = areas[side.region.vertex], along = side.contact.displacement.dot(event.normal);
    const Vector3 normal = along < 0 ? event.normal : Vector3(-event.normal);
    gathering.add_volume(labels[number], -area * (1 - event.time) * std::abs(along));
    const CornerGradients corners = gradient == PublishedGradient::whole
                                        ? whole_gradient(event, side.contact, normal, start, end)
                                        : frozen_gradient(event, side.contact, normal);
    for (std::size_t k = 0; k < 4; ++k)
      if (!corners[k].isZero(0)) gathering.add_gradient(labels[number], event.vertices[k], area * corners[k]);
  }
  return gathering.stivs();
}

}  // namespace stiv
