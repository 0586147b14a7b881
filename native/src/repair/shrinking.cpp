// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/shrinking.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace stiv {

namespace {

constexpr double factors[] = {1.0 / 2, 1.0 / 4, 1.0 / 8, 1.0 / 32, 1.0 / 128};

using PairVertices = std::vector<std::vector<Index>>;

/// Pairs of which some vertices belong to a part and some do not.
Index crossing(const PairVertices& pairs, const Marks& part) {
  const auto is_marked = [&](Index vertex) { return part[at(vertex)] != 0; };
  return static_cast<Index>(std::count_if(pairs.begin(), pairs.end(), [&](const std::vector<Index>& pair) {
    return std::any_of(pair.begin(), pair.end(), is_marked) && !std::all_of(pair.begin(), pair.end(), is_marked);
  }));
}

/// The marked controls nearer to their mean by a factor.
Controls shrunk(const Controls& p, const Marks& controls, double factor) {
  Eigen::RowVector3d middle = Eigen::RowVector3d::Zero();
  double count = 0;
  for (Index row = 0; row < p.rows(); ++row)
    if (controls[at(row)] != 0) {
      middle += p.row(row);
      count += 1;
    }
  middle /= count;
  Controls nearer = p;
  for (Index row = 0; row < p.rows(); ++row)
    if (controls[at(row)] != 0) nearer.row(row) = middle + factor * (p.row(row) - middle);
  return nearer;
}

}  // namespace

Contracted shrink_components(const CagedSurface& caged, const Movable& movable, const ContractionOptions& options,
                             const Controls& start, Execution& execution) {
  IntersectionTest test(caged.surface);
  const auto pairs_at = [&](const Controls& p) {
    execution.check();
    return vertices_of_pairs(*caged.surface,
                             find_static_pairs(test, caged.deformation->surface_in_range(p), execution));
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
      const Index meeting = crossing(pairs, components[k]);
      if (meeting == 0) break;
      Controls tried = as_stored(shrunk(before, controls, factors[step]), options.storage);
      PairVertices left = pairs_at(tried);
      ++state.steps;
      if (crossing(left, components[k]) >= meeting) continue;
      state.positions = std::move(tried);
      pairs = std::move(left);
    }
  }
  state.pairs = static_cast<Index>(pairs.size());
  return state;
}

}  // namespace stiv
