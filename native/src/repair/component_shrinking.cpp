// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/component_shrinking.hpp"

#include <algorithm>
#include <span>
#include <utility>

namespace stiv {

namespace {

constexpr double factors[] = {1.0 / 2, 1.0 / 4, 1.0 / 8, 1.0 / 32, 1.0 / 128};
/// Not the whole size: contacts right at the start of the expansion would hold it back.
constexpr double grown_factors[] = {1.0 / 2, 1.0 / 4, 1.0 / 8, 1.0 / 16, 1.0 / 32, 1.0 / 64};
constexpr int max_growths = 2;  // of each component, which may wait for others

using PairVertices = std::vector<std::vector<Index>>;

/// Number of pairs between a component and the rest.
Index pairs_with_others(const PairVertices& pairs, const Marks& component) {
  const auto is_marked = [&](Index vertex) { return component[at(vertex)] != 0; };
  return static_cast<Index>(std::count_if(pairs.begin(), pairs.end(), [&](const std::vector<Index>& pair) {
    return std::any_of(pair.begin(), pair.end(), is_marked) && !std::all_of(pair.begin(), pair.end(), is_marked);
  }));
}

/// p with the marked controls of `shape` scaled about their mean.
Controls scaled(const Controls& p, const Controls& shape, const Marks& controls, double factor) {
  Eigen::RowVector3d mean = Eigen::RowVector3d::Zero();
  double count = 0;
  for (Index row = 0; row < shape.rows(); ++row)
    if (controls[at(row)] != 0) {
      mean += shape.row(row);
      count += 1;
    }
  mean /= count;
  Controls result = p;
  for (Index row = 0; row < p.rows(); ++row)
    if (controls[at(row)] != 0) result.row(row) = mean + factor * (shape.row(row) - mean);
  return result;
}

class ComponentShrinking {
 public:
  ComponentShrinking(const CagedSurface& caged, const Movable& movable, const ContractionOptions& options,
                     const Controls& start, Execution& execution)
      : caged_(caged),
        movable_(movable),
        options_(options),
        execution_(execution),
        test_(caged.surface),
        start_(as_stored(start, options.storage)),
        state_{start_, 0, 0},
        pairs_(pairs_at(start_)),
        components_(components_in_pairs(*caged.surface, pairs_, movable.vertices)),
        factors_(components_.size(), 1) {}

  Contracted run() {
    for (std::size_t k = 0; k < components_.size(); ++k) {
      execution_.report("contraction", static_cast<double>(k) / static_cast<double>(components_.size()));
      shrink(k);
    }
    for (int growth = 0; growth < max_growths; ++growth)
      for (std::size_t k = 0; k < components_.size(); ++k) grow(k);
    state_.pairs = static_cast<Index>(pairs_.size());
    return std::move(state_);
  }

 private:
  PairVertices pairs_at(const Controls& p) {
    execution_.check();
    return vertices_of_pairs(*caged_.surface, test_.find_all(caged_.deformation->surface_in_range(p), execution_));
  }

  void shrink(std::size_t k) {
    const Marks controls = controls_of(components_[k], movable_);
    if (std::none_of(controls.begin(), controls.end(), [](unsigned char mark) { return mark != 0; })) return;
    const Controls before = state_.positions;
    for (const double factor : allowed(factors)) {
      const Index intersecting = pairs_with_others(pairs_, components_[k]);
      if (intersecting == 0) return;
      Controls tried = as_stored(scaled(before, before, controls, factor), options_.storage);
      PairVertices remaining = pairs_at(tried);
      ++state_.steps;
      if (pairs_with_others(remaining, components_[k]) < intersecting)
        accept(k, factor, std::move(tried), std::move(remaining));
    }
  }

  /// Gives a component the largest factor at which no more pairs intersect. When it was shrunk, others had their whole
  /// size.
  void grow(std::size_t k) {
    const Marks controls = controls_of(components_[k], movable_);
    for (const double factor : allowed(grown_factors)) {
      if (factor <= factors_[k]) return;
      Controls tried = as_stored(scaled(state_.positions, start_, controls, factor), options_.storage);
      PairVertices remaining = pairs_at(tried);
      ++state_.steps;
      if (remaining.size() > pairs_.size() ||
          pairs_with_others(remaining, components_[k]) > pairs_with_others(pairs_, components_[k]))
        continue;
      return accept(k, factor, std::move(tried), std::move(remaining));
    }
  }

  void accept(std::size_t k, double factor, Controls tried, PairVertices remaining) {
    factors_[k] = factor;
    state_.positions = std::move(tried);
    pairs_ = std::move(remaining);
  }

  std::span<const double> allowed(std::span<const double> all) const {
    return all.first(std::min(all.size(), static_cast<std::size_t>(options_.max_steps)));
  }

  const CagedSurface& caged_;
  const Movable& movable_;
  const ContractionOptions& options_;
  Execution& execution_;
  IntersectionTest test_;
  const Controls start_;
  Contracted state_;
  PairVertices pairs_;  ///< of the state
  std::vector<Marks> components_;
  std::vector<double> factors_;  ///< of the components' size
};

}  // namespace

Contracted shrink_components(const CagedSurface& caged, const Movable& movable, const ContractionOptions& options,
                             const Controls& start, Execution& execution) {
  return ComponentShrinking(caged, movable, options, start, execution).run();
}

}  // namespace stiv
