// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/deformation/concatenation.hpp"

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>

#include "deformation/checks.hpp"
#include "position_rows.hpp"
#include "stiv/error.hpp"

namespace stiv {

namespace {

/// Where rows of the whole belong: the part, and the row within the part; part -1 where no part has it.
struct Places {
  std::vector<Index> part, row;
};

Places vertex_places(const std::vector<DeformationPart>& parts, Index vertex_count) {
  const auto count = static_cast<std::size_t>(vertex_count);
  Places places{std::vector<Index>(count, -1), std::vector<Index>(count, -1)};
  for (std::size_t part = 0; part < parts.size(); ++part)
    for (std::size_t row = 0; row < parts[part].vertices.size(); ++row) {
      const Index vertex = parts[part].vertices[row];
      const std::string name = "concatenation, part " + std::to_string(part) + ", vertex " + std::to_string(vertex);
      if (vertex < 0 || vertex >= vertex_count)
        throw InputError(name + ": the surface has vertices 0 to " + std::to_string(vertex_count - 1));
      const auto v = static_cast<std::size_t>(vertex);
      if (places.part[v] >= 0)
        throw InputError(name + ": already moved by part " + std::to_string(places.part[v]) +
                         "; a vertex may be moved once");
      places.part[v] = static_cast<Index>(part);
      places.row[v] = static_cast<Index>(row);
    }
  return places;
}

/// First control of each part, and the number of all at the end.
std::vector<Index> control_starts(const std::vector<DeformationPart>& parts) {
  std::vector<Index> starts{0};
  for (const DeformationPart& part : parts) starts.push_back(starts.back() + part.deformation->control_count());
  return starts;
}

Places control_places(const std::vector<Index>& starts) {
  Places places;
  for (std::size_t part = 0; part + 1 < starts.size(); ++part)
    for (Index row = 0; row < starts[part + 1] - starts[part]; ++row) {
      places.part.push_back(static_cast<Index>(part));
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

/// A field over the whole, cut into one over each part.
std::vector<SparseField> split(const SparseField& field, const Places& places, std::size_t part_count) {
  std::vector<SparseField> pieces(part_count);
  for (std::size_t k = 0; k < field.index.size(); ++k) {
    const std::size_t row = at(field.index[k]);
    if (places.part[row] < 0) continue;
    SparseField& piece = pieces[at(places.part[row])];
    piece.index.push_back(places.row[row]);
    piece.value.push_back(field.value[k]);
  }
  for (SparseField& piece : pieces) piece = sorted(std::move(piece));
  return pieces;
}

void append(SparseField& whole, const SparseField& piece, Index first) {
  for (const Index index : piece.index) whole.index.push_back(first + index);
  whole.value.insert(whole.value.end(), piece.value.begin(), piece.value.end());
}

/// No copy: J and the metric are asked for at the same controls once for each of thousands of contacts.
ControlsView rows_of_part(const ControlsView& p, const std::vector<Index>& starts, std::size_t part) {
  return p.middleRows(starts[part], starts[part + 1] - starts[part]);
}

/// The options for some controls of `options`, those from `first` on.
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
    const std::vector<SparseField> pieces = split(g, places_, blocks_.size());
    SparseField step;
    for (std::size_t part = 0; part < blocks_.size(); ++part)
      if (!pieces[part].index.empty())
        append(step, blocks_[part]->apply_inverse(rows_of_part(p, starts_, part), pieces[part]), starts_[part]);
    return step;
  }

  bool is_local() const override {
    return std::all_of(blocks_.begin(), blocks_.end(), [](const auto& block) { return block->is_local(); });
  }

 private:
  std::vector<std::unique_ptr<Metric>> blocks_;
  std::vector<Index> starts_;
  Places places_;
};

class Concatenation final : public Deformation {
 public:
  Concatenation(std::vector<DeformationPart> parts, Positions start)
      : parts_(std::move(parts)),
        start_(std::move(start)),
        vertex_places_(vertex_places(parts_, static_cast<Index>(start_.rows()))),
        control_starts_(control_starts(parts_)),
        control_places_(control_places(control_starts_)) {}

  Index control_count() const override { return control_starts_.back(); }
  Index vertex_count() const override { return static_cast<Index>(start_.rows()); }

  Positions surface(const Controls& p, const Execution& execution) const override {
    check_control_rows(p, control_count());
    Positions q = start_;
    for (std::size_t part = 0; part < parts_.size(); ++part)
      place(parts_[part].deformation->surface(rows_of_part(p, control_starts_, part), execution), part, q, execution);
    return q;
  }

  Positions surface_rows(const Controls& p, std::span<const Index> vertices,
                         const Execution& execution) const override {
    check_control_rows(p, control_count());
    Positions q = rows_of(start_, vertices);
    std::vector<std::vector<Index>> places(parts_.size()), rows(parts_.size());
    for (std::size_t k = 0; k < vertices.size(); ++k) {
      const auto vertex = static_cast<std::size_t>(vertices[k]);
      if (vertex_places_.part[vertex] < 0) continue;
      const auto part = static_cast<std::size_t>(vertex_places_.part[vertex]);
      places[part].push_back(static_cast<Index>(k));
      rows[part].push_back(vertex_places_.row[vertex]);
    }
    for (std::size_t part = 0; part < parts_.size(); ++part)
      if (!rows[part].empty())
        put_rows(q, places[part],
                 parts_[part].deformation->surface_rows(rows_of_part(p, control_starts_, part), rows[part], execution));
    return q;
  }

  SparseField pull_back(const ControlsView& p, const SparseField& g) const override {
    const std::vector<SparseField> pieces = split(g, vertex_places_, parts_.size());
    SparseField pulled;
    for (std::size_t part = 0; part < parts_.size(); ++part)
      if (!pieces[part].index.empty())
        append(pulled, parts_[part].deformation->pull_back(rows_of_part(p, control_starts_, part), pieces[part]),
               control_starts_[part]);
    return pulled;
  }

  std::vector<SparseField> pull_back_all(const ControlsView& p, const std::vector<SparseField>& g,
                                         const Execution& execution) const override {
    std::vector<std::vector<std::size_t>> whose(parts_.size());  // of each part's covectors
    std::vector<std::vector<SparseField>> of_parts(parts_.size());
    for (std::size_t k = 0; k < g.size(); ++k) {
      std::vector<SparseField> pieces = split(g[k], vertex_places_, parts_.size());
      for (std::size_t part = 0; part < parts_.size(); ++part) {
        if (pieces[part].index.empty()) continue;
        whose[part].push_back(k);
        of_parts[part].push_back(std::move(pieces[part]));
      }
    }
    std::vector<SparseField> pulled(g.size());
    for (std::size_t part = 0; part < parts_.size(); ++part) {
      if (whose[part].empty()) continue;
      const std::vector<SparseField> pieces =
          parts_[part].deformation->pull_back_all(rows_of_part(p, control_starts_, part), of_parts[part], execution);
      for (std::size_t k = 0; k < pieces.size(); ++k) append(pulled[whose[part][k]], pieces[k], control_starts_[part]);
    }
    return pulled;
  }

  Positions push_forward(const Controls& p, const Controls& d) const override {
    check_control_rows(p, control_count());
    check_control_rows(d, control_count());
    Positions velocity = Positions::Zero(vertex_count(), 3);
    for (std::size_t part = 0; part < parts_.size(); ++part)
      place(parts_[part].deformation->push_forward(rows_of_part(p, control_starts_, part),
                                                   rows_of_part(d, control_starts_, part)),
            part, velocity, Execution(1));
    return velocity;
  }

  std::unique_ptr<Metric> metric(const MetricOptions& options) const override {
    checked_weights(options, control_count());
    std::vector<std::unique_ptr<Metric>> blocks;
    for (std::size_t part = 0; part < parts_.size(); ++part) {
      const Index count = control_starts_[part + 1] - control_starts_[part];
      blocks.push_back(
          parts_[part].deformation->metric(options_of_rows(options, control_starts_[part], count, control_count())));
    }
    return std::make_unique<BlockMetric>(std::move(blocks), control_starts_);
  }

  std::vector<Index> support(Index control) const override {
    const std::size_t row = at(control);
    const DeformationPart& part = parts_[at(control_places_.part[row])];
    std::vector<Index> vertices = part.deformation->support(control_places_.row[row]);
    for (Index& vertex : vertices) vertex = part.vertices[at(vertex)];
    if (!std::is_sorted(vertices.begin(), vertices.end())) std::sort(vertices.begin(), vertices.end());
    return vertices;
  }

  std::vector<Index> rotation_rows() const override {
    std::vector<Index> rows;
    for (std::size_t part = 0; part < parts_.size(); ++part)
      for (const Index row : parts_[part].deformation->rotation_rows()) rows.push_back(control_starts_[part] + row);
    return rows;
  }

 private:
  void place(const Positions& piece, std::size_t part, Positions& whole, const Execution& execution) const {
    constexpr Index rows_per_chunk = 8192;
    const std::vector<Index>& vertices = parts_[part].vertices;
    execution.for_chunks(static_cast<Index>(piece.rows()), rows_per_chunk, [&](Index begin, Index end, Index) {
      for (Index row = begin; row < end; ++row) whole.row(vertices[at(row)]) = piece.row(row);
    });
  }

  std::vector<DeformationPart> parts_;
  Positions start_;
  Places vertex_places_;
  std::vector<Index> control_starts_;
  Places control_places_;
};

void check_parts(const std::vector<DeformationPart>& parts) {
  for (std::size_t part = 0; part < parts.size(); ++part) {
    const std::string name = "concatenation, part " + std::to_string(part);
    if (!parts[part].deformation) throw InputError(name + ": no deformation given");
    const Index expected = parts[part].deformation->vertex_count();
    if (static_cast<Index>(parts[part].vertices.size()) != expected)
      throw InputError(name + ": " + std::to_string(parts[part].vertices.size()) +
                       " vertices given, its deformation moves " + std::to_string(expected));
  }
}

}  // namespace

std::shared_ptr<const Deformation> make_concatenation(std::vector<DeformationPart> parts, Positions start) {
  check_parts(parts);
  check_finite(start, "concatenation, start of vertex");
  return std::make_shared<Concatenation>(std::move(parts), std::move(start));
}

}  // namespace stiv
