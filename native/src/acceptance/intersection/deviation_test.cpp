// SPDX-License-Identifier: GPL-3.0-or-later
// Derivation: mathematics.md, "Surfaces within rounding".
#include "acceptance/intersection/deviation_test.hpp"

#include <atomic>
#include <cmath>
#include <utility>

#include "acceptance/intersection/candidate_test.hpp"
#include "stiv/coordinate_range.hpp"

namespace stiv {

namespace {

PackedPoints packed(const PositionsView& q) {
  PackedPoints points;
  points.reserve(static_cast<std::size_t>(q.rows()));  // not set to zero first
  for (Index row = 0; row < q.rows(); ++row) points.push_back({{q(row, 0), q(row, 1), q(row, 2), 0}});
  return points;
}

/// Does `test(begin, end)` hold for all chunks of [0, count)?
template <class Test>
bool all_chunks(std::size_t count, const Execution& execution, const Test& test) {
  constexpr Index chunk_size = 1024;
  std::atomic<bool> holds{true};
  execution.for_chunks(static_cast<Index>(count), chunk_size, [&](Index begin, Index end, Index) {
    if (holds.load(std::memory_order_relaxed) && !test(at(begin), at(end)))
      holds.store(false, std::memory_order_relaxed);
  });
  return holds;
}

}  // namespace

DeviationTest::Implementation::Implementation(std::shared_ptr<const Surface> surface,
                                              std::shared_ptr<const Stars> stars,
                                              std::shared_ptr<const Positions> accepted,
                                              std::shared_ptr<const NearPairs> near)
    : surface_(std::move(surface)), stars_(std::move(stars)), accepted_(std::move(accepted)), near_(std::move(near)) {}

std::optional<bool> DeviationTest::Implementation::is_free(const PositionsView& q, const Execution& execution) const {
  if (!is_within_reach(q)) return std::nullopt;
  const PackedPoints points = packed(q);
  return are_pairs_free(q, points, execution) && are_stars_free(q, points, execution);
}

/// A difference is rounded, so that it may lie half a unit in the last place above the reach. The pairs hold for this.
bool DeviationTest::Implementation::is_within_reach(const PositionsView& q) const {
  bool is_near = q.rows() == accepted_->rows(), is_valid = is_near;
  if (is_near) {
    const double *shown = q.data(), *accepted = accepted_->data();
    for (std::ptrdiff_t k = 0; k < accepted_->size(); ++k) {
      is_near &= std::abs(shown[k] - accepted[k]) <= near_->reach;
      is_valid &= is_valid_coordinate(shown[k]);
    }
  }
  if (!is_valid) surface_->check_positions(q);
  return is_near;
}

bool DeviationTest::Implementation::are_stars_free(const PositionsView& q, const PackedPoints& points,
                                                   const Execution& execution) const {
  const std::vector<Index> unproven = stars_->find_unproven(near_->stars, points, execution);
  return all_chunks(unproven.size(), execution, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      if (!is_star_free(q, unproven[k])) return false;
    return true;
  });
}

bool DeviationTest::Implementation::is_star_free(const PositionsView& q, Index vertex) const {
  return !stars_->any_pair(vertex, [&](const CornerPair& pair) { return intersect(*surface_, pair, q); });
}

bool DeviationTest::Implementation::are_pairs_free(const PositionsView& q, const PackedPoints& points,
                                                   const Execution& execution) const {
  return all_chunks(near_->pairs.size(), execution, [&](std::size_t begin, std::size_t end) {
    CandidateTest test(*surface_, q, points, nullptr, [](const PrimitivePair&) { return false; });
    for (std::size_t k = begin; k < end; ++k)
      if (!test.add({}, near_->pairs[k].first, near_->pairs[k].second)) return false;
    return test.finish();
  });
}

DeviationTest::DeviationTest(std::unique_ptr<const Implementation> implementation)
    : implementation_(std::move(implementation)) {}
DeviationTest::~DeviationTest() = default;

double DeviationTest::reach() const { return implementation_->reach(); }

std::optional<bool> DeviationTest::is_free(const PositionsView& q, Execution& execution) const {
  const FloatingPointScope floating_point;
  return implementation_->is_free(q, execution);
}

}  // namespace stiv
