// SPDX-License-Identifier: GPL-3.0-or-later
#include "penetration/crossings.hpp"

#include <tuple>

#include "penetration/piercing.hpp"

namespace stiv {

namespace {

std::array<Index, 2> edge_between(Index a, Index b) { return {std::min(a, b), std::max(a, b)}; }

auto key(const EdgeCrossing& crossing) { return std::tuple(crossing.edge, crossing.triangle); }

void sort_and_unify(std::vector<EdgeCrossing>& crossings) {
  std::sort(crossings.begin(), crossings.end(), [](const auto& a, const auto& b) { return key(a) < key(b); });
  const auto same = [](const auto& a, const auto& b) { return key(a) == key(b); };
  crossings.erase(std::unique(crossings.begin(), crossings.end(), same), crossings.end());
}

/// Weights of the second and third corner at a fraction of the side from corner k.
Eigen::Vector2d weights_on_side(std::size_t k, double fraction) {
  std::array<double, 3> weights{};
  weights[k] = 1 - fraction;
  weights[(k + 1) % 3] = fraction;
  return {weights[1], weights[2]};
}

}  // namespace

Crossings::Crossings(const PlacedBody& first, const PlacedBody& second, const IndexPairs& candidates, int perturbation)
    : bodies_{&first, &second}, perturbation_(perturbation) {
  for (const auto& [a, b] : candidates) add({a, b});
  for (auto& crossings : crossings_) sort_and_unify(crossings);
}

void Crossings::add(const std::array<Index, 2>& triangles) {
  Cut cut{triangles, {}};
  std::array<bool, 2> found{};
  for (const std::size_t side : {std::size_t{0}, std::size_t{1}}) {
    const PlacedBody &own = body(side), &other = body(1 - side);
    const auto& corners = own.corners(triangles[side]);
    for (std::size_t k = 0; k < 3; ++k) {
      // In a canonical order, so that both triangles of an edge compute the same crossing.
      const std::array<Index, 2> edge = edge_between(corners[k], corners[(k + 1) % 3]);
      const auto pierced = piercing({own.point(edge[0]), own.point(edge[1])}, other.triangle(triangles[1 - side]),
                                    perturbation(side), touching_);
      if (!pierced) continue;
      crossings_[side].push_back({edge, triangles[1 - side], pierced->step, pierced->at});
      // Around each triangle, the cut begins where a side of the first triangle comes from the back of the second, or
      // where a side of the second goes to the back of the first.
      const bool forward = corners[k] == edge[0], upward = forward ? pierced->step < 0 : pierced->step > 0;
      const std::size_t end = upward == (side == 0) ? 0 : 1;
      found[end] = true;
      cut.ends[side][end] = weights_on_side(k, forward ? pierced->at : 1 - pierced->at);
      cut.ends[1 - side][end] = pierced->weights;
    }
  }
  if (found[0] && found[1]) cuts_.push_back(cut);
}

/// Calls visit(crossing) for the crossings of an edge.
template <class Visit>
void Crossings::along(std::size_t side, Index a, Index b, const Visit& visit) const {
  const std::array<Index, 2> edge = edge_between(a, b);
  const auto before = [](const EdgeCrossing& crossing, const std::array<Index, 2>& e) { return crossing.edge < e; };
  const auto end = crossings_[side].end();
  for (auto k = std::lower_bound(crossings_[side].begin(), end, edge, before); k != end && k->edge == edge; ++k)
    visit(*k);
}

int Crossings::winding_increase(std::size_t side, Index from, Index to) const {
  int sum = 0;
  along(side, from, to, [&](const EdgeCrossing& c) { sum += from < to ? c.step : -c.step; });
  return sum;
}

double Crossings::mean_along(std::size_t side, Index from, Index to, int at_beginning) const {
  double mean = at_beginning;
  along(side, from, to, [&](const EdgeCrossing& c) { mean += from < to ? c.step * (1 - c.at) : -c.step * c.at; });
  return mean;
}

}  // namespace stiv
