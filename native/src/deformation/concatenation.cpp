// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/deformation/combination.hpp"

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>

#include "deformation/checks.hpp"
#include "position_rows.hpp"
#include "stiv/error.hpp"

namespace stiv {

namespace {

/// For each row of the whole, its component and its row in that component; component -1 if it is in none.
struct Places {
  std::vector<Index> component, row;
};

Places vertex_places(const std::vector<DeformationComponent>& components, Index vertex_count) {
  const auto count = static_cast<std::size_t>(vertex_count);
  Places places{std::vector<Index>(count, -1), std::vector<Index>(count, -1)};
  for (std::size_t component = 0; component < components.size(); ++component)
    for (std::size_t row = 0; row < components[component].vertices.size(); ++row) {
      const Index vertex = components[component].vertices[row];
      const std::string name =
          "concatenation, component " + std::to_string(component) + ", vertex " + std::to_string(vertex);
      if (vertex < 0 || vertex >= vertex_count)
        throw InputError(name + ": the surface has vertices 0 to " + std::to_string(vertex_count - 1));
      const auto v = static_cast<std::size_t>(vertex);
      if (places.component[v] >= 0)
        throw InputError(name + ": already in component " + std::to_string(places.component[v]) +
                         "; a vertex may be in one component");
      places.component[v] = static_cast<Index>(component);
      places.row[v] = static_cast<Index>(row);
    }
  return places;
}

/// Rows [begin, end) that are in no component.
std::vector<std::pair<Index, Index>> runs_without_component(const Places& places) {
  std::vector<std::pair<Index, Index>> runs;
  for (std::size_t row = 0; row < places.component.size(); ++row) {
    if (places.component[row] >= 0) continue;
    const auto begin = static_cast<Index>(row);
    if (runs.empty() || runs.back().second != begin) runs.emplace_back(begin, begin);
    ++runs.back().second;
  }
  return runs;
}

/// The first control of each component, followed by the number of all controls.
std::vector<Index> control_starts(const std::vector<DeformationComponent>& components) {
  std::vector<Index> starts{0};
  for (const DeformationComponent& component : components)
    starts.push_back(starts.back() + component.deformation->control_count());
  return starts;
}

Places control_places(const std::vector<Index>& starts) {
  Places places;
  for (std::size_t component = 0; component + 1 < starts.size(); ++component)
    for (Index row = 0; row < starts[component + 1] - starts[component]; ++row) {
      places.component.push_back(static_cast<Index>(component));
      places.row.push_back(row);
    }
  return places;
}

SparseField sorted(SparseField field) {
  if (std::is_sorted(field.index.begin(), field.index.end())) return field;
  std::vector<std::size_t> order(field.index.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return field.index[a] < field.index[b]; });
  SparseField result;
  for (const std::size_t k : order) {
    result.index.push_back(field.index[k]);
    result.value.push_back(field.value[k]);
  }
  return result;
}

/// The restrictions of a field to each component.
std::vector<SparseField> split(const SparseField& field, const Places& places, std::size_t component_count) {
  std::vector<SparseField> fields(component_count);
  for (std::size_t k = 0; k < field.index.size(); ++k) {
    const std::size_t row = at(field.index[k]);
    if (places.component[row] < 0) continue;
    SparseField& restriction = fields[at(places.component[row])];
    restriction.index.push_back(places.row[row]);
    restriction.value.push_back(field.value[k]);
  }
  for (SparseField& restriction : fields) restriction = sorted(std::move(restriction));
  return fields;
}

/// In exactly the memory of the added field if it is the first: hundreds of steps are kept at once.
void append(SparseField& whole, SparseField added, Index first) {
  for (Index& index : added.index) index += first;
  if (whole.index.empty()) {
    whole = std::move(added);
    return;
  }
  whole.index.insert(whole.index.end(), added.index.begin(), added.index.end());
  whole.value.insert(whole.value.end(), added.value.begin(), added.value.end());
}

void append(Eigen::VectorXd& whole, const Eigen::VectorXd& added) {
  whole.conservativeResize(whole.size() + added.size());
  whole.tail(added.size()) = added;
}

/// A view, not a copy: J and the metric are evaluated at the same controls for thousands of contacts.
ControlsView rows_of_component(const ControlsView& p, const std::vector<Index>& starts, std::size_t component) {
  return p.middleRows(starts[component], starts[component + 1] - starts[component]);
}

/// The options for controls [first, first + count).
MetricOptions options_of_rows(const MetricOptions& options, Index first, Index count, Index control_count) {
  MetricOptions some{options.smoothness, {}, {}};
  if (options.weights.size() > 0) {
    const Index values = static_cast<Index>(options.weights.size()) / control_count;
    some.weights = options.weights.segment(values * first, values * count);
  }
  if (!options.weight_axes.empty())
    some.weight_axes.assign(options.weight_axes.begin() + first, options.weight_axes.begin() + first + count);
  return some;
}

class BlockMetric final : public Metric {
 public:
  BlockMetric(std::vector<std::unique_ptr<Metric>> blocks, std::vector<Index> starts)
      : blocks_(std::move(blocks)), starts_(std::move(starts)), places_(control_places(starts_)) {}

  SparseField apply_inverse(const ControlsView& p, const SparseField& g) const override {
    const std::vector<SparseField> fields = split(g, places_, blocks_.size());
    SparseField step;
    for (std::size_t component = 0; component < blocks_.size(); ++component)
      if (!fields[component].index.empty())
        append(step, blocks_[component]->apply_inverse(rows_of_component(p, starts_, component), fields[component]),
               starts_[component]);
    return step;
  }

  bool is_local() const override {
    return std::all_of(blocks_.begin(), blocks_.end(), [](const auto& block) { return block->is_local(); });
  }

  bool is_ready() const override {
    return std::all_of(blocks_.begin(), blocks_.end(), [](const auto& block) { return block->is_ready(); });
  }

 private:
  std::vector<std::unique_ptr<Metric>> blocks_;
  std::vector<Index> starts_;
  Places places_;
};

class Concatenation final : public Deformation {
 public:
  Concatenation(std::vector<DeformationComponent> components, Positions start)
      : components_(std::move(components)),
        start_(std::move(start)),
        vertex_places_(vertex_places(components_, static_cast<Index>(start_.rows()))),
        resting_(runs_without_component(vertex_places_)),
        control_starts_(control_starts(components_)),
        control_places_(control_places(control_starts_)) {}

  Index control_count() const override { return control_starts_.back(); }
  Index vertex_count() const override { return static_cast<Index>(start_.rows()); }

  Positions surface(const Controls& p, const Execution& execution) const override {
    check_control_rows(p, control_count());
    Positions q(start_.rows(), 3);
    for (const auto& [begin, end] : resting_) q.middleRows(begin, end - begin) = start_.middleRows(begin, end - begin);
    for (std::size_t component = 0; component < components_.size(); ++component)
      components_[component].deformation->put_surface(rows_of_component(p, control_starts_, component),
                                                      components_[component].vertices, q, execution);
    return q;
  }

  Positions surface_rows(const Controls& p, std::span<const Index> vertices,
                         const Execution& execution) const override {
    check_control_rows(p, control_count());
    Positions q = rows_of(start_, vertices);
    std::vector<std::vector<Index>> places(components_.size()), rows(components_.size());
    for (std::size_t k = 0; k < vertices.size(); ++k) {
      const auto vertex = static_cast<std::size_t>(vertices[k]);
      if (vertex_places_.component[vertex] < 0) continue;
      const auto component = static_cast<std::size_t>(vertex_places_.component[vertex]);
      places[component].push_back(static_cast<Index>(k));
      rows[component].push_back(vertex_places_.row[vertex]);
    }
    for (std::size_t component = 0; component < components_.size(); ++component)
      if (!rows[component].empty())
        put_rows(q, places[component],
                 components_[component].deformation->surface_rows(rows_of_component(p, control_starts_, component),
                                                                  rows[component], execution));
    return q;
  }

  bool has_exact_rows() const override {
    return std::ranges::all_of(components_, [](const auto& each) { return each.deformation->has_exact_rows(); });
  }

  SparseField pull_back(const ControlsView& p, const SparseField& g) const override {
    const std::vector<SparseField> fields = split(g, vertex_places_, components_.size());
    SparseField pulled;
    for (std::size_t component = 0; component < components_.size(); ++component)
      if (!fields[component].index.empty())
        append(pulled,
               components_[component].deformation->pull_back(rows_of_component(p, control_starts_, component),
                                                             fields[component]),
               control_starts_[component]);
    return pulled;
  }

  std::vector<SparseField> pull_back_all(const ControlsView& p, const std::vector<SparseField>& g,
                                         const Execution& execution) const override {
    std::vector<std::vector<std::size_t>> sources(components_.size());  // the covector of each restriction
    std::vector<std::vector<SparseField>> restrictions(components_.size());
    for (std::size_t k = 0; k < g.size(); ++k) {
      std::vector<SparseField> fields = split(g[k], vertex_places_, components_.size());
      for (std::size_t component = 0; component < components_.size(); ++component) {
        if (fields[component].index.empty()) continue;
        sources[component].push_back(k);
        restrictions[component].push_back(std::move(fields[component]));
      }
    }
    std::vector<SparseField> pulled(g.size());
    for (std::size_t component = 0; component < components_.size(); ++component) {
      if (sources[component].empty()) continue;
      const std::vector<SparseField> fields = components_[component].deformation->pull_back_all(
          rows_of_component(p, control_starts_, component), restrictions[component], execution);
      for (std::size_t k = 0; k < fields.size(); ++k)
        append(pulled[sources[component][k]], fields[k], control_starts_[component]);
    }
    return pulled;
  }

  Positions push_forward(const Controls& p, const Controls& d) const override {
    check_control_rows(p, control_count());
    check_control_rows(d, control_count());
    Positions velocity = Positions::Zero(vertex_count(), 3);
    for (std::size_t component = 0; component < components_.size(); ++component)
      place(components_[component].deformation->push_forward(rows_of_component(p, control_starts_, component),
                                                             rows_of_component(d, control_starts_, component)),
            component, velocity, Execution(1));
    return velocity;
  }

  Influence influence(const Controls& p, const Eigen::VectorXd& distances, const Execution& execution) const override {
    check_control_rows(p, control_count());
    Influence whole;
    for (std::size_t component = 0; component < components_.size(); ++component) {
      const Influence added = components_[component].deformation->influence(
          rows_of_component(p, control_starts_, component), distances(components_[component].vertices), execution);
      append(whole.largest, added.largest);
      append(whole.miss, added.miss);
    }
    return whole;
  }

  std::unique_ptr<Metric> metric(const MetricOptions& options) const override {
    checked_weights(options, control_count());
    std::vector<std::unique_ptr<Metric>> blocks;
    for (std::size_t component = 0; component < components_.size(); ++component) {
      const Index count = control_starts_[component + 1] - control_starts_[component];
      blocks.push_back(components_[component].deformation->metric(
          options_of_rows(options, control_starts_[component], count, control_count())));
    }
    return std::make_unique<BlockMetric>(std::move(blocks), control_starts_);
  }

  std::vector<Index> support(Index control) const override {
    const std::size_t row = at(control);
    const DeformationComponent& component = components_[at(control_places_.component[row])];
    std::vector<Index> vertices = component.deformation->support(control_places_.row[row]);
    for (Index& vertex : vertices) vertex = component.vertices[at(vertex)];
    if (!std::is_sorted(vertices.begin(), vertices.end())) std::sort(vertices.begin(), vertices.end());
    return vertices;
  }

  std::uint64_t revision() const override {
    std::uint64_t sum = 0;
    for (const DeformationComponent& component : components_) sum += component.deformation->revision();
    return sum;
  }

  std::vector<Index> rotation_rows() const override {
    std::vector<Index> rows;
    for (std::size_t component = 0; component < components_.size(); ++component)
      for (const Index row : components_[component].deformation->rotation_rows())
        rows.push_back(control_starts_[component] + row);
    return rows;
  }

  ScalarRows scalar_rows() const override {
    ScalarRows scalars;
    for (std::size_t component = 0; component < components_.size(); ++component) {
      const ScalarRows added = components_[component].deformation->scalar_rows();
      for (const Index row : added.rows) scalars.rows.push_back(control_starts_[component] + row);
      append(scalars.limits.lower, added.limits.lower);
      append(scalars.limits.upper, added.limits.upper);
      append(scalars.limits.longest_step, added.limits.longest_step);
    }
    return scalars;
  }

 private:
  void place(const Positions& values, std::size_t component, Positions& whole, const Execution& execution) const {
    constexpr Index rows_per_chunk = 8192;
    const std::vector<Index>& vertices = components_[component].vertices;
    execution.for_chunks(static_cast<Index>(values.rows()), rows_per_chunk, [&](Index begin, Index end, Index) {
      for (Index row = begin; row < end; ++row) whole.row(vertices[at(row)]) = values.row(row);
    });
  }

  std::vector<DeformationComponent> components_;
  Positions start_;
  Places vertex_places_;
  std::vector<std::pair<Index, Index>> resting_;  ///< [begin, end) of vertices in no component
  std::vector<Index> control_starts_;
  Places control_places_;
};

void check_components(const std::vector<DeformationComponent>& components) {
  for (std::size_t component = 0; component < components.size(); ++component) {
    const std::string name = "concatenation, component " + std::to_string(component);
    if (!components[component].deformation) throw InputError(name + ": no deformation given");
    const Index expected = components[component].deformation->vertex_count();
    if (static_cast<Index>(components[component].vertices.size()) != expected)
      throw InputError(name + ": " + std::to_string(components[component].vertices.size()) +
                       " vertices given, its deformation moves " + std::to_string(expected));
  }
}

}  // namespace

std::shared_ptr<const Deformation> make_concatenation(std::vector<DeformationComponent> components, Positions start) {
  check_components(components);
  check_finite(start, "concatenation, start of vertex");
  return std::make_shared<Concatenation>(std::move(components), std::move(start));
}

}  // namespace stiv
