// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/contraction_strategies.hpp"

#include <algorithm>

#include "repair/component_shrinking.hpp"

namespace stiv {

namespace {

constexpr int region_rings[] = {2, 4, 8, 16, 32};
constexpr int passes_of_region = 4;  // contraction moves the intersections

/// Contracts the marked vertices, starting at `state`.
void contract_further(const CagedSurface& caged, const Marks& vertices, const Movable& movable,
                      const ContractionOptions& options, Contracted& state, Execution& execution) {
  ContractionResult result = contract(caged, state.positions, controls_of(vertices, movable), options, execution);
  state.steps += static_cast<Index>(result.pairs.size()) - 1;
  state.pairs = *std::min_element(result.pairs.begin(), result.pairs.end());
  state.positions = std::move(result.positions);
}

std::vector<std::vector<Index>> intersecting_at(const CagedSurface& caged, const Controls& p, Execution& execution) {
  IntersectionTest test(caged.surface);
  return vertices_of_pairs(*caged.surface, test.find_all(caged.deformation->surface_in_range(p), execution));
}

Contracted contract_components(const CagedSurface& caged, const Movable& movable, const ContractionOptions& options,
                               const Controls& start, Execution& execution) {
  Contracted state{start, 0, 0};
  const auto pairs = intersecting_at(caged, start, execution);
  for (const Marks& component : components_in_pairs(*caged.surface, pairs, movable.vertices)) {
    contract_further(caged, component, movable, options, state, execution);
    if (state.pairs == 0) break;
  }
  return state;
}

Contracted contract_regions(const CagedSurface& caged, const Movable& movable, const ContractionOptions& options,
                            const Controls& start, Execution& execution) {
  Contracted state{start, 0, 0};
  for (const int rings : region_rings)
    for (int pass = 0; pass < passes_of_region; ++pass) {
      const auto pairs = intersecting_at(caged, state.positions, execution);
      const Marks region = region_around(*caged.surface, pairs, rings, movable.vertices);
      contract_further(caged, region, movable, options, state, execution);
      if (state.pairs == 0) return state;
      if (state.pairs >= static_cast<Index>(pairs.size())) break;
    }
  return state;
}

/// Shrinks components until they are apart, then contracts the remaining intersections within them.
Contracted shrink_then_contract(const CagedSurface& caged, const Movable& movable, const ContractionOptions& options,
                                const Controls& start, Execution& execution) {
  Contracted apart = shrink_components(caged, movable, options, start, execution);
  if (apart.pairs == 0 || apart.positions == start) return apart;
  Contracted whole = contract_regions(caged, movable, options, apart.positions, execution);
  whole.steps += apart.steps;
  return whole;
}

}  // namespace

Marks controls_of(const Marks& vertices, const Movable& movable) {
  Marks controls = controls_moving(vertices, movable.supports);
  for (std::size_t k = 0; k < controls.size(); ++k) controls[k] &= movable.controls[k];
  return controls;
}

std::vector<ContractionStrategy> contraction_strategies(const CagedSurface& caged, const StaticPairs& pairs,
                                                        const Movable& movable, const ContractionOptions& options) {
  const auto contract_marked = [=](const Marks& marks) {
    return [=](const Controls& start, Execution& execution) {
      Contracted state{start, 0, 0};
      contract_further(caged, marks, movable, options, state, execution);
      return state;
    };
  };
  const Surface& surface = *caged.surface;
  const auto vertices = vertices_of_pairs(surface, pairs);
  const std::vector<Index> bodies = bodies_in_pairs(surface, vertices);
  std::vector<ContractionStrategy> strategies;
  if (bodies.size() > 1)
    for (const Index body : bodies_in_all_pairs(surface, vertices)) {
      const std::string& name = surface.bodies()[at(body)].name;
      strategies.push_back({name, contract_marked(marks_of_bodies(surface, {body}, movable.vertices))});
    }
  strategies.push_back({"all", contract_marked(marks_of_bodies(surface, bodies, movable.vertices))});
  strategies.push_back({"shrunk components", [=](const Controls& start, Execution& execution) {
                          return shrink_then_contract(caged, movable, options, start, execution);
                        }});
  strategies.push_back({"components", [=](const Controls& start, Execution& execution) {
                          return contract_components(caged, movable, options, start, execution);
                        }});
  strategies.push_back({"regions", [=](const Controls& start, Execution& execution) {
                          return contract_regions(caged, movable, options, start, execution);
                        }});
  return strategies;
}

}  // namespace stiv
