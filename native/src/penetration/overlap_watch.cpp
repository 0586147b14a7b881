// SPDX-License-Identifier: GPL-3.0-or-later
#include "penetration/overlap_watch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "penetration/depth_watch.hpp"
#include "position_rows.hpp"

namespace stiv {

namespace {

constexpr double stride_in_depths = 0.25;
constexpr double least_stride = 1e-3, largest_stride = 1.0 / 16;  // in diagonals of the smaller body
constexpr double most_samples = 256;
constexpr double shortest_retry = 1e-2;  // in strides

BodyPairs meeting_pairs(const Surface& surface, BodyPairs pairs) {
  for (auto& [a, b] : pairs)
    if (b < a) std::swap(a, b);
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  std::erase_if(pairs, [&](const auto& pair) { return !surface.bodies_meet(pair.first, pair.second); });
  return pairs;
}

/// For each body of the surface, its number among those in the pairs; -1 for all others.
std::vector<Index> numbered(const Surface& surface, const BodyPairs& pairs) {
  std::vector<Index> numbers(surface.bodies().size(), -1);
  for (const auto& [a, b] : pairs) numbers[at(a)] = numbers[at(b)] = 0;
  Index count = 0;
  for (Index& number : numbers)
    if (number == 0) number = count++;
  return numbers;
}

/// The triangles of numbered bodies, with their vertices numbered as in `vertices`, ascending.
Triangles triangles_of(const Surface& surface, const std::vector<Index>& numbers, const std::vector<Index>& vertices) {
  const Triangles& all = surface.triangles();
  std::vector<Index> rows;
  for (Index row = 0; row < static_cast<Index>(all.rows()); ++row)
    if (numbers[at(surface.body_of(all(row, 0)))] >= 0) rows.push_back(row);
  Triangles triangles(static_cast<Index>(rows.size()), 3);
  for (std::size_t k = 0; k < rows.size(); ++k)
    for (int corner = 0; corner < 3; ++corner) {
      const auto place = std::lower_bound(vertices.begin(), vertices.end(), all(rows[k], corner));
      triangles(static_cast<Index>(k), corner) = static_cast<Index>(place - vertices.begin());
    }
  return triangles;
}

}  // namespace

OverlapWatch::OverlapWatch(const Surface& surface, const BodyPairs& pairs, double rounding)
    : pairs_(meeting_pairs(surface, pairs)), rounding_(rounding) {
  const std::vector<Index> numbers = numbered(surface, pairs_);
  SurfaceDefinition bodies;
  for (Index vertex = 0; vertex < surface.vertex_count(); ++vertex) {
    const Index number = numbers[at(surface.body_of(vertex))];
    if (number < 0) continue;
    vertices_of_.resize(std::max(vertices_of_.size(), static_cast<std::size_t>(number) + 1));
    vertices_of_[at(number)].push_back(static_cast<Index>(vertices_.size()));
    vertices_.push_back(vertex);
    bodies.vertex_body.push_back(number);
  }
  bodies.vertex_count = static_cast<Index>(vertices_.size());
  bodies.triangles = triangles_of(surface, numbers, vertices_);
  for (std::size_t body = 0; body < numbers.size(); ++body)
    if (numbers[body] >= 0) bodies.bodies.push_back({surface.bodies()[body].name, Mobility::rigid});
  vertices_of_.resize(bodies.bodies.size());
  for (const auto& [a, b] : pairs_) watched_.push_back({numbers[at(a)], numbers[at(b)]});
  const auto is_watched = [&](Index a, Index b) {
    return std::any_of(watched_.begin(), watched_.end(),
                       [&](const Watched& w) { return w.first == a && w.second == b; });
  };
  for (Index a = 0; a < static_cast<Index>(bodies.bodies.size()); ++a)
    for (Index b = a + 1; b < static_cast<Index>(bodies.bodies.size()); ++b)
      if (!is_watched(a, b)) bodies.ignored.emplace_back(a, b);
  bodies_ = std::make_shared<Surface>(std::move(bodies));
  test_.emplace(bodies_);
}

void OverlapWatch::begin(const Positions& q, Execution& execution) {
  const Positions rows = watched_rows(q);
  BodyPairs bodies;
  for (const Watched& pair : watched_) bodies.emplace_back(pair.first, pair.second);
  penetrations_.emplace(BodyPenetrations::of_bodies(bodies_, bodies, rows, rounding_));
  measured_ = penetrations_->pairs();
  start_ = measure(rows, execution);
  for (std::size_t k = 0; k < watched_.size(); ++k) {
    watched_[k].common_box = common_box(watched_[k], start_.q);
    watched_[k].stride = stride_of(k, start_);
  }
}

const std::vector<unsigned char>& OverlapWatch::overlapping(const Positions& q, Execution& execution) {
  return measure_accepted(watched_rows(q), execution).overlapping;
}

bool OverlapWatch::is_deeper(const Positions& q, Execution& execution) {
  return is_deeper(measure(watched_rows(q), execution));
}

double OverlapWatch::free_fraction(const Positions& from, const Positions& to, Execution& execution) {
  const Positions start = watched_rows(from), end = watched_rows(to);
  const std::vector<unsigned char> before = measure_accepted(start, execution).overlapping;
  double strides = 0;
  for (std::size_t k = 0; k < watched_.size(); ++k)
    if (before[k] != 0)
      strides = std::max(strides, relative_displacement(watched_[k], start, end) / watched_[k].stride);
  if (strides == 0) return 1;
  const double count = std::ceil(strides), tested = std::min(count, most_samples);
  for (double sample = 1; sample <= tested; ++sample) {
    execution.check();
    const Positions q = sample == count ? end : Positions(start + sample / count * (end - start));
    const State& state = measure(q, execution);
    if (is_deeper(state)) return sample > 1 ? (sample - 1) / count : strides > shortest_retry ? 0.25 / count : 0;
    const auto comes_apart = [&](std::size_t k) { return before[k] != 0 && state.overlapping[k] == 0; };
    for (std::size_t k = 0; k < watched_.size(); ++k)
      if (comes_apart(k)) return sample / count;
  }
  return tested / count;
}

Positions OverlapWatch::watched_rows(const Positions& q) const { return rows_of(q, vertices_); }

/// The state at positions of the watched vertices. Only bodies displaced since the last state are measured again.
const OverlapWatch::State& OverlapWatch::measure(Positions q, Execution& execution) {
  const bool is_first = last_.q.rows() != q.rows();
  if (!is_first && last_.q == q) return last_;
  const IndexPairs intersecting = test_->find(q, execution);
  if (is_first) last_.penetrations.assign(measured_.size(), {});
  const std::vector<unsigned char> displaced =
      is_first ? std::vector<unsigned char>(vertices_of_.size(), 1) : displaced_bodies(*bodies_, last_.q, q);
  penetrations_->update(last_.penetrations, displaced, q, intersecting);
  last_.q = std::move(q);
  mark_overlapping(last_, intersecting);
  return last_;
}

const OverlapWatch::State& OverlapWatch::measure_accepted(Positions q, Execution& execution) {
  if (accepted_.q.rows() != q.rows() || accepted_.q != q) accepted_ = measure(std::move(q), execution);
  return accepted_;
}

/// A pair overlaps if its surfaces intersect, or one body lies inside the other.
void OverlapWatch::mark_overlapping(State& state, const IndexPairs& intersecting) const {
  state.overlapping.assign(watched_.size(), 0);
  for (const auto& [a, b] : intersecting) {
    const auto body = [&](Index triangle) { return bodies_->body_of(bodies_->triangles()(triangle, 0)); };
    state.overlapping[pair_of({body(a), body(b)})] = 1;
  }
  for (std::size_t k = 0; k < measured_.size(); ++k)
    if (state.penetrations[k].amount > 0) state.overlapping[pair_of(measured_[k].bodies)] = 1;
}

bool OverlapWatch::is_deeper(const State& state) const {
  for (std::size_t k = 0; k < measured_.size(); ++k) {
    const Penetration& now = state.penetrations[k];
    if (now.amount - now.uncertainty <= start_.penetrations[k].amount) continue;
    const Watched& pair = watched_[pair_of(measured_[k].bodies)];
    const bool is_open = !measured_[k].closed[0] && !measured_[k].closed[1];
    if (!is_open || common_box(pair, state.q) > pair.common_box) return true;
  }
  return false;
}

std::size_t OverlapWatch::pair_of(const std::array<Index, 2>& bodies) const {
  const auto found = std::find_if(watched_.begin(), watched_.end(), [&](const Watched& pair) {
    return pair.first == std::min(bodies[0], bodies[1]) && pair.second == std::max(bodies[0], bodies[1]);
  });
  return static_cast<std::size_t>(found - watched_.begin());
}

/// The amount of a penetration, divided by its change per displacement, is a depth.
double OverlapWatch::stride_of(std::size_t pair, const State& start) const {
  const double diagonal = std::min(box_of(watched_[pair].first, start.q).diagonal().norm(),
                                   box_of(watched_[pair].second, start.q).diagonal().norm());
  double stride = largest_stride * diagonal;
  for (std::size_t k = 0; k < measured_.size(); ++k) {
    const Penetration& measured = start.penetrations[k];
    if (pair_of(measured_[k].bodies) != pair || !measured_[k].closed[1] || !(measured.uncertainty > 0)) continue;
    stride = std::min(stride, stride_in_depths * measured.amount * rounding_ / measured.uncertainty);
  }
  return std::max({stride, least_stride * diagonal, std::numeric_limits<double>::min()});
}

/// The largest displacement of a vertex, apart from the mean displacement of the first body.
double OverlapWatch::relative_displacement(const Watched& pair, const Positions& from, const Positions& to) const {
  Eigen::RowVector3d mean = Eigen::RowVector3d::Zero();
  for (const Index vertex : vertices_of_[at(pair.first)]) mean += to.row(vertex) - from.row(vertex);
  mean /= static_cast<double>(vertices_of_[at(pair.first)].size());
  double largest = 0;
  for (const Index body : {pair.first, pair.second})
    for (const Index vertex : vertices_of_[at(body)])
      largest = std::max(largest, (to.row(vertex) - from.row(vertex) - mean).norm());
  return largest;
}

Eigen::AlignedBox3d OverlapWatch::box_of(Index body, const Positions& q) const {
  Eigen::AlignedBox3d box;
  for (const Index vertex : vertices_of_[at(body)]) box.extend(Vector3(q.row(vertex)));
  return box;
}

/// The volume common to the boxes of both bodies.
double OverlapWatch::common_box(const Watched& pair, const Positions& q) const {
  const Eigen::AlignedBox3d common = box_of(pair.first, q).intersection(box_of(pair.second, q));
  return common.isEmpty() ? 0 : common.volume();
}

}  // namespace stiv
