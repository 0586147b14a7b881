// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/component_shrinking.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace stiv {

namespace {

constexpr double factors[] = {1.0 / 2, 1.0 / 4, 1.0 / 8, 1.0 / 32, 1.0 / 128};

using PairVertices = std::vector<std::vector<Index>>;

/// Number of pairs between a component and the rest.
Index pairs_with_others(const PairVertices& pairs, const Marks& component) {
  const auto is_marked = [&](Index vertex) { return component[at(vertex)] != 0; };
  return static_cast<Index>(std::count_if(pairs.begin(), pairs.end(), [&](const std::vector<Index>& pair) {
    return std::any_of(pair.begin(), pair.end(), is_marked) && !std::all_of(pair.begin(), pair.end(), is_marked);
  }));
}

/// Scales the marked controls about their mean.
Controls scaled(const Controls& p, const Marks& controls, double factor) {
  Eigen::RowVector3d mean = Eigen::RowVector3d::Zero();
  double count = 0;
  for (Index row = 0; row < p.rows(); ++row)
    if (controls[at(row)] != 0) {
      mean += p.row(row);
      count += 1;
    }
  mean /= count;
  Controls result = p;
  for (Index row = 0; row < p.rows(); ++row)
    if (controls[at(row)] != 0) result.row(row) = mean + factor * (p.row(row) - mean);
  return result;
}

}  // namespace

Contracted shrink_components(const CagedSurface& caged, const Movable& movable, const ContractionOptions& options,
                             const Controls& start, Execution& execution) {
  IntersectionTest test(caged.surface);
  const auto pairs_at = [&](const Controls& p) {
    execution.check();
    return vertices_of_pairs(*caged.surface, test.find_all(caged.deformation->surface_in_range(p), execution));
  };
  const std::size_t steps = std::min(std::size(factors), static_cast<std::size_t>(options.max_steps));
  Contracted state{as_stored(start, options.storage), 0, 0};
  PairVertices pairs = pairs_at(state.positions);
  const std::vector<Marks> components = components_in_pairs(*caged.surface, pairs, movable.vertices);
  for (std::size_t k = 0; k < components.size(); ++k) {
    execution.report("contraction", static_cast<double>(k) / static_cast<double>(components.size()));
    const Marks controls = controls_of(components[k], movable);
    if (std::none_of(controls.begin(), controls.end(), [](unsigned char mark) { return mark != 0; })) continue;
    const Controls before = state.positions;
    for (std::size_t step = 0; step < steps; ++step) {
      const Index intersecting = pairs_with_others(pairs, components[k]);
      if (intersecting == 0) break;
      Controls tried = as_stored(scaled(before, controls, factors[step]), options.storage);
      PairVertices remaining = pairs_at(tried);
      ++state.steps;
      if (pairs_with_others(remaining, components[k]) >= intersecting) continue;
      state.positions = std::move(tried);
      pairs = std::move(remaining);
    }
  }
  state.pairs = static_cast<Index>(pairs.size());
  return state;
}

}  // namespace stiv
