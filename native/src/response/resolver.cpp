// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/response/resolver.hpp"

#include <algorithm>
#include <cmath>
#include <span>
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

constexpr Index steps_per_chunk = 4, rows_per_chunk = 64;

/// Entries of the longest step that is kept. Sweeps over rows with longer ones take longer than a Gram matrix of the
/// largest set of coupled constraints, 512.
constexpr std::size_t longest_kept_step = 170;

std::vector<SparseField> pulled_back(const std::vector<Stiv>& stivs, const Deformation& deformation, const Controls& p,
                                     const Execution& execution) {
  std::vector<SparseField> gradients;
  for (const Stiv& stiv : stivs) gradients.push_back(stiv.gradient);
  return deformation.pull_back_all(p, gradients, execution);
}

/// The constraints of consecutive STIVs.
/// @param rows their gradients over the controls, which are moved from
std::vector<ControlConstraint> normalised(std::span<const Stiv> stivs, std::span<SparseField> rows, const Controls& p,
                                          const Metric& metric, const Controls& metric_at, const Execution& execution) {
  std::vector<SparseField> steps(rows.size());
  execution.for_chunks(static_cast<Index>(rows.size()), steps_per_chunk, [&](Index begin, Index end, Index) {
    for (Index k = begin; k < end; ++k) steps[at(k)] = metric.apply_inverse(metric_at, rows[at(k)]);
  });
  std::vector<ControlConstraint> constraints;
  for (std::size_t k = 0; k < stivs.size(); ++k) {
    ControlConstraint constraint{std::move(rows[k]), std::move(steps[k]), 0};
    const double squared_length = dot(constraint.row, constraint.step);
    if (!(squared_length > least_squared_length * squared_norm(stivs[k].gradient))) continue;
    const double normalise = 1 / std::sqrt(squared_length);
    scale(constraint.row, normalise);
    scale(constraint.step, normalise);
    constraint.bound = dot(constraint.row, p) - normalise * stivs[k].volume;
    constraints.push_back(std::move(constraint));
  }
  return constraints;
}

/// The covector sum of multiplier times row over the constraints whose steps are not kept.
SparseField sum_without_steps(const std::vector<ControlConstraint>& constraints, const Eigen::VectorXd& multipliers,
                              Index control_count) {
  Controls sum = Controls::Zero(control_count, 3);
  for (std::size_t r = 0; r < constraints.size(); ++r) {
    const double multiplier = multipliers[static_cast<Eigen::Index>(r)];
    if (multiplier != 0 && constraints[r].step.index.empty()) add_scaled(sum, multiplier, constraints[r].row);
  }
  SparseField covector;
  for (Index control = 0; control < control_count; ++control) {
    if (sum.row(control).isZero(0)) continue;
    covector.index.push_back(control);
    covector.value.push_back(sum.row(control).transpose());
  }
  return covector;
}

}  // namespace

std::vector<ControlConstraint> control_constraints(const std::vector<Stiv>& stivs, const Deformation& deformation,
                                                   const Controls& p, const Metric& metric, const Controls& metric_at,
                                                   const Execution* execution) {
  const Execution alone(1);
  const Execution& shared = execution != nullptr ? *execution : alone;
  std::vector<SparseField> rows = pulled_back(stivs, deformation, p, shared);
  return normalised(stivs, rows, p, metric, metric_at, shared);
}

void ConstraintSet::add(std::vector<ControlConstraint> constraints, const Execution& execution, std::size_t expected) {
  const std::size_t before = size();
  for (ControlConstraint& constraint : constraints) constraints_.push_back(std::move(constraint));
  const auto is_long = [](const ControlConstraint& c) { return c.step.index.size() > longest_kept_step; };
  if (std::none_of(constraints_.begin() + static_cast<std::ptrdiff_t>(before), constraints_.end(), is_long)) return;
  try {
    reserve_gram(expected);
    extend_gram(execution);
  } catch (...) {
    keep_first(before);
    throw;
  }
  for (std::size_t k = before; k < size(); ++k)
    if (is_long(constraints_[k])) constraints_[k].step = {};
}

bool ConstraintSet::has_limit(Index limit) const {
  return std::any_of(constraints_.begin(), constraints_.end(), [&](const auto& c) { return c.limit == limit; });
}

void ConstraintSet::reserve_gram(std::size_t count) {
  const auto rows = static_cast<Eigen::Index>(count);
  if (gram_.rows() < rows) gram_.conservativeResize(rows, rows);
}

void ConstraintSet::keep_first(std::size_t count) {
  constraints_.resize(std::min(count, size()));
  const auto most = static_cast<Eigen::Index>(size());
  in_gram_ = std::min(in_gram_, most);
  if (multipliers_.size() > most) multipliers_.conservativeResize(most);
}

/// Computes the new columns first: the Gram matrix of steps that are not kept must survive an interruption.
void ConstraintSet::extend_gram(const Execution& execution) {
  const Eigen::Index before = in_gram_, after = static_cast<Eigen::Index>(size()), count = after - before;
  if (count == 0) return;
  Eigen::MatrixXd columns(after, count);
  const RowControls controls(constraints_);
  constexpr auto width = static_cast<Eigen::Index>(StepTile::width);
  for (Eigen::Index first = 0; first < count; first += width) {
    const Eigen::Index last = std::min(first + width, count);
    const StepTile steps({constraints_.data() + before + first, constraints_.data() + before + last}, controls);
    execution.for_chunks(static_cast<Index>(after), rows_per_chunk, [&](Index begin, Index end, Index) {
      StepTile::Products products;
      for (Index row = begin; row < end; ++row) {
        if (row >= before && row < before + first) continue;  // the columns of these rows have the products
        steps.multiply(constraints_[at(row)].row, products);
        columns.row(row).segment(first, last - first) =
            Eigen::Map<const Eigen::RowVectorXd>(products.data(), last - first);
      }
    });
  }
  reserve_gram(size());
  gram_.block(0, before, after, count) = columns;
  gram_.block(before, 0, count, before) = columns.topRows(before).transpose();
  gram_.block(before, before, count, count).triangularView<Eigen::StrictlyUpper>() =
      columns.bottomRows(count).transpose();
  in_gram_ = after;
}

/// Makes the Gram matrix that of all constraints.
void ConstraintSet::complete_gram(const Execution& execution) {
  extend_gram(execution);
  if (gram_.rows() > in_gram_) gram_.conservativeResize(in_gram_, in_gram_);
}

void ConstraintSet::drop_inactive() {
  std::vector<Eigen::Index> active, in_gram;
  for (Eigen::Index r = 0; r < multipliers_.size(); ++r) {
    if (!(multipliers_[r] > 0)) continue;
    active.push_back(r);
    if (r < in_gram_) in_gram.push_back(r);
  }
  Eigen::MatrixXd gram = gram_(in_gram, in_gram);
  Eigen::VectorXd multipliers = multipliers_(active);
  for (std::size_t k = 0; k < active.size(); ++k)
    if (static_cast<Eigen::Index>(k) != active[k]) constraints_[k] = std::move(constraints_[active[k]]);
  constraints_.resize(active.size());
  gram_ = std::move(gram);
  in_gram_ = gram_.rows();
  multipliers_ = std::move(multipliers);
}

Controls ConstraintSet::project(const Controls& from, const Metric& metric, const Controls& metric_at,
                                const Execution& execution) {
  LcpOptions options;
  options.execution = &execution;
  if (keeps_all_steps() && sweep_cost(constraints_) < constraints_.size() * constraints_.size())
    return project_by_rows(constraints_, from, multipliers_, options);
  complete_gram(execution);
  multipliers_ = solve_lcp(gram_, excess_at(from), multipliers_, options);
  return moved_by_multipliers(from, metric, metric_at);
}

Controls ConstraintSet::project_as_equations(const Controls& from, const Metric& metric, const Controls& metric_at,
                                             const Execution& execution) {
  complete_gram(execution);
  // Dependent rows are common: take the least-squares solution of least norm.
  multipliers_ = gram_.completeOrthogonalDecomposition().solve(-excess_at(from));
  return moved_by_multipliers(from, metric, metric_at);
}

bool ConstraintSet::keeps_all_steps() const {
  return std::none_of(constraints_.begin(), constraints_.end(), [](const auto& c) { return c.step.index.empty(); });
}

Eigen::VectorXd ConstraintSet::excess_at(const Controls& p) const {
  Eigen::VectorXd excess(static_cast<Eigen::Index>(constraints_.size()));
  for (Eigen::Index r = 0; r < excess.size(); ++r) excess[r] = dot(constraints_[r].row, p) - constraints_[r].bound;
  return excess;
}

Controls ConstraintSet::moved_by_multipliers(const Controls& from, const Metric& metric,
                                             const Controls& metric_at) const {
  Controls p = from;
  for (Eigen::Index r = 0; r < multipliers_.size(); ++r)
    if (multipliers_[r] != 0) add_scaled(p, multipliers_[r], constraints_[r].step);
  const SparseField covector = sum_without_steps(constraints_, multipliers_, static_cast<Index>(from.rows()));
  if (!covector.index.empty()) add_scaled(p, 1, metric.apply_inverse(metric_at, covector));
  return p;
}

std::size_t add_constraints(ConstraintSet& set, const std::vector<Stiv>& stivs, const Deformation& deformation,
                            const Controls& p, const Metric& metric, const Controls& metric_at,
                            const Execution& execution) {
  const std::size_t before = set.size();
  std::vector<SparseField> rows = pulled_back(stivs, deformation, p, execution);
  try {
    for (std::size_t begin = 0; begin < rows.size(); begin += StepTile::width) {
      const std::size_t count = std::min(StepTile::width, rows.size() - begin);
      set.add(normalised({stivs.data() + begin, count}, {rows.data() + begin, count}, p, metric, metric_at, execution),
              execution, before + rows.size());
    }
  } catch (...) {
    set.keep_first(before);
    throw;
  }
  return set.size() - before;
}

}  // namespace stiv
