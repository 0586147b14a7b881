// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/response/resolver.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "response/row_projection.hpp"
#include "response/sparse_fields.hpp"
#include "response/step_tile.hpp"
#include "stiv/response/lcp.hpp"

namespace stiv {

namespace {

/// Squared length of a row in the metric J'J, relative to its upper bound, that of the volume's gradient. Below this
/// fraction a row is rounding: free controls move all corners of the contacts equally, or none.
constexpr double least_squared_length = 1e-24;

constexpr Index steps_per_chunk = 8;

}  // namespace

std::vector<ControlConstraint> control_constraints(const std::vector<Stiv>& stivs, const Deformation& deformation,
                                                   const Controls& p, const Metric& metric, const Controls& metric_at,
                                                   const Execution* execution) {
  const Execution alone(1);
  const Execution& shared = execution != nullptr ? *execution : alone;
  std::vector<SparseField> gradients;
  for (const Stiv& stiv : stivs) gradients.push_back(stiv.gradient);
  std::vector<SparseField> rows = deformation.pull_back_all(p, gradients, shared), steps(rows.size());
  shared.for_chunks(static_cast<Index>(rows.size()), steps_per_chunk, [&](Index begin, Index end, Index) {
    for (Index k = begin; k < end; ++k) steps[at(k)] = metric.apply_inverse(metric_at, rows[at(k)]);
  });
  std::vector<ControlConstraint> constraints;
  for (std::size_t k = 0; k < stivs.size(); ++k) {
    ControlConstraint constraint{std::move(rows[k]), std::move(steps[k]), 0};
    const double squared_length = dot(constraint.row, constraint.step);
    if (!(squared_length > least_squared_length * squared_norm(gradients[k]))) continue;
    const double normalise = 1 / std::sqrt(squared_length);
    scale(constraint.row, normalise);
    scale(constraint.step, normalise);
    constraint.bound = dot(constraint.row, p) - normalise * stivs[k].volume;
    constraints.push_back(std::move(constraint));
  }
  return constraints;
}

void ConstraintSet::add(std::vector<ControlConstraint> constraints) {
  for (ControlConstraint& constraint : constraints) constraints_.push_back(std::move(constraint));
}

bool ConstraintSet::has_limit(Index limit) const {
  return std::any_of(constraints_.begin(), constraints_.end(), [&](const auto& c) { return c.limit == limit; });
}

void ConstraintSet::complete_gram(const Execution& execution) {
  const auto before = static_cast<Index>(gram_.rows()), after = static_cast<Index>(constraints_.size());
  Eigen::MatrixXd gram = std::exchange(gram_, Eigen::MatrixXd());  // computed again if interrupted
  gram.conservativeResize(after, after);
  const RowControls controls(constraints_);
  execution.for_chunks(after - before, StepTile::width, [&](Index begin, Index end, Index) {
    const Index first = before + begin, last = before + end;
    const StepTile steps({constraints_.data() + first, constraints_.data() + last}, controls);
    StepTile::Products products;
    for (Index row = 0; row < after; ++row) {
      if (row >= before && row < first) continue;  // computed with the tile of that row's step
      steps.multiply(constraints_[at(row)].row, products);
      for (Index column = first; column < last; ++column)
        if (row < before || row >= column) gram(row, column) = gram(column, row) = products[at(column - first)];
    }
  });
  gram_ = std::move(gram);
}

void ConstraintSet::drop_inactive() {
  std::vector<Eigen::Index> active;
  for (Eigen::Index r = 0; r < multipliers_.size(); ++r)
    if (multipliers_[r] > 0) active.push_back(r);
  keep(active);
}

void ConstraintSet::drop_part(Index period, Index first) {
  std::vector<Eigen::Index> kept;
  for (Eigen::Index r = 0; r < multipliers_.size(); ++r)
    if (r % period != first) kept.push_back(r);
  keep(kept);
}

/// Keeps these constraints of those that were projected, ascending, and removes all others.
void ConstraintSet::keep(const std::vector<Eigen::Index>& numbers) {
  const auto end = std::lower_bound(numbers.begin(), numbers.end(), gram_.rows());
  const std::vector<Eigen::Index> in_gram(numbers.begin(), end);
  Eigen::MatrixXd gram = gram_(in_gram, in_gram);
  Eigen::VectorXd multipliers = multipliers_(numbers);
  for (std::size_t k = 0; k < numbers.size(); ++k)
    if (static_cast<Eigen::Index>(k) != numbers[k]) constraints_[k] = std::move(constraints_[numbers[k]]);
  constraints_.resize(numbers.size());
  gram_ = std::move(gram);
  multipliers_ = std::move(multipliers);
}

Controls ConstraintSet::project(const Controls& from, const Execution& execution) {
  LcpOptions options;
  options.execution = &execution;
  if (sweep_cost(constraints_) < constraints_.size() * constraints_.size())
    return project_by_rows(constraints_, from, multipliers_, options);
  complete_gram(execution);
  multipliers_ = solve_lcp(gram_, excess_at(from), multipliers_, options);
  return moved_by_multipliers(from);
}

Controls ConstraintSet::project_as_equations(const Controls& from, const Execution& execution) {
  complete_gram(execution);
  // Dependent rows are common: take the least-squares solution of least norm.
  multipliers_ = gram_.completeOrthogonalDecomposition().solve(-excess_at(from));
  return moved_by_multipliers(from);
}

Eigen::VectorXd ConstraintSet::excess_at(const Controls& p) const {
  Eigen::VectorXd excess(static_cast<Eigen::Index>(constraints_.size()));
  for (Eigen::Index r = 0; r < excess.size(); ++r) excess[r] = dot(constraints_[r].row, p) - constraints_[r].bound;
  return excess;
}

Controls ConstraintSet::moved_by_multipliers(const Controls& from) const {
  Controls p = from;
  for (Eigen::Index r = 0; r < multipliers_.size(); ++r)
    if (multipliers_[r] != 0) add_scaled(p, multipliers_[r], constraints_[r].step);
  return p;
}

}  // namespace stiv
