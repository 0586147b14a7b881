// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/contraction_tries.hpp"

#include <algorithm>

namespace stiv {

namespace {

constexpr int region_rings[] = {2, 4, 8, 16, 32};
constexpr int passes_of_region = 4;  // contraction moves the intersections, and the region follows them

using SurfacePointer = std::shared_ptr<const Surface>;

/// Contracts one part of what an earlier contraction left.
void contract_further(const SurfacePointer& surface, const Marks& part, const ContractionOptions& options,
                      Contracted& state, Execution& execution) {
  ContractionResult result = contract(surface, state.positions, part, options, execution);
  state.steps += static_cast<Index>(result.pairs.size()) - 1;
  state.pairs = *std::min_element(result.pairs.begin(), result.pairs.end());
  state.positions = std::move(result.positions);
}

std::vector<std::vector<Index>> intersecting_at(const SurfacePointer& surface, const Positions& q,
                                                Execution& execution) {
  IntersectionTest test(surface);
  return vertices_of_pairs(*surface, find_static_pairs(test, q, execution));
}

Contracted contract_components(const SurfacePointer& surface, const Marks& movable, const ContractionOptions& options,
                               const Positions& start, Execution& execution) {
  Contracted state{start, 0, 0};
  const auto pairs = intersecting_at(surface, start, execution);
  for (const Marks& component : components_in_pairs(*surface, pairs, movable)) {
    contract_further(surface, component, options, state, execution);
    if (state.pairs == 0) break;
  }
  return state;
}

Contracted contract_regions(const SurfacePointer& surface, const Marks& movable, const ContractionOptions& options,
                            const Positions& start, Execution& execution) {
  Contracted state{start, 0, 0};
  for (const int rings : region_rings)
    for (int pass = 0; pass < passes_of_region; ++pass) {
      const auto pairs = intersecting_at(surface, state.positions, execution);
      contract_further(surface, region_around(*surface, pairs, rings, movable), options, state, execution);
      if (state.pairs == 0) return state;
      if (state.pairs >= static_cast<Index>(pairs.size())) break;
    }
  return state;
}

}  // namespace

std::vector<ContractionTry> contraction_tries(const SurfacePointer& surface, const StaticPairs& pairs,
                                              const Marks& movable, const ContractionOptions& options) {
  const auto part = [=](const Marks& marks) {
    return [=](const Positions& start, Execution& execution) {
      Contracted state{start, 0, 0};
      contract_further(surface, marks, options, state, execution);
      return state;
    };
  };
  const auto vertices = vertices_of_pairs(*surface, pairs);
  const std::vector<Index> bodies = bodies_in_pairs(*surface, vertices);
  std::vector<ContractionTry> tries;
  if (bodies.size() > 1)
    for (const Index body : bodies_in_all_pairs(*surface, vertices))
      tries.push_back(
          {surface->bodies()[static_cast<std::size_t>(body)].name, part(marks_of_bodies(*surface, {body}, movable))});
  tries.push_back({"all", part(marks_of_bodies(*surface, bodies, movable))});
  tries.push_back({"components", [=](const Positions& start, Execution& execution) {
                     return contract_components(surface, movable, options, start, execution);
                   }});
  tries.push_back({"regions", [=](const Positions& start, Execution& execution) {
                     return contract_regions(surface, movable, options, start, execution);
                   }});
  return tries;
}

}  // namespace stiv
