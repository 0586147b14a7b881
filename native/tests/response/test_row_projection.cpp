// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <algorithm>
#include <random>

#include "response/row_projection.hpp"

using namespace stiv;

namespace {

/// A constraint on `width` random controls, of length one in the metric diag(1 / weights).
ControlConstraint random_constraint(std::mt19937& random, Index count, int width, const Eigen::VectorXd& weights) {
  std::uniform_real_distribution<double> number(-1, 1);
  std::vector<Index> all(static_cast<std::size_t>(count));
  for (Index k = 0; k < count; ++k) all[static_cast<std::size_t>(k)] = k;
  std::shuffle(all.begin(), all.end(), random);
  all.resize(static_cast<std::size_t>(width));
  std::sort(all.begin(), all.end());
  ControlConstraint constraint;
  double squared_length = 0;
  for (const Index k : all) {
    const Vector3 value(number(random), number(random), number(random));
    constraint.row.index.push_back(k);
    constraint.row.value.push_back(value);
    squared_length += weights[k] * value.squaredNorm();
  }
  for (Vector3& value : constraint.row.value) value /= std::sqrt(squared_length);
  constraint.step = constraint.row;
  for (std::size_t k = 0; k < all.size(); ++k) constraint.step.value[k] *= weights[all[k]];
  constraint.bound = number(random);
  return constraint;
}

double product(const SparseField& field, const Controls& p) {
  double sum = 0;
  for (std::size_t k = 0; k < field.index.size(); ++k) sum += field.value[k].dot(p.row(field.index[k]).transpose());
  return sum;
}

Controls dense(const SparseField& field, Index count) {
  Controls p = Controls::Zero(count, 3);
  for (std::size_t k = 0; k < field.index.size(); ++k) p.row(field.index[k]) = field.value[k].transpose();
  return p;
}

}  // namespace

TEST_CASE("row projection: the same point as the LCP with its matrix, from any first guess") {
  std::mt19937 random(3);
  const Index count = 60;
  for (int trial = 0; trial < 20; ++trial) {
    const Eigen::VectorXd weights = Eigen::VectorXd::Random(count).array() * 0.5 + 1;
    std::vector<ControlConstraint> constraints;
    for (int r = 0; r < 40; ++r) constraints.push_back(random_constraint(random, count, 4, weights));
    const Controls from = Controls::Random(count, 3);
    Eigen::MatrixXd gram(40, 40);
    Eigen::VectorXd excess(40);
    for (int r = 0; r < 40; ++r) {
      for (int s = 0; s < 40; ++s) gram(r, s) = product(constraints[r].row, dense(constraints[s].step, count));
      excess[r] = product(constraints[r].row, from) - constraints[r].bound;
    }
    const Eigen::VectorXd expected = solve_lcp(gram, excess);
    Controls point = from;
    for (int r = 0; r < 40; ++r) point += expected[r] * dense(constraints[r].step, count);
    for (const int given : {0, 10, 40}) {
      Eigen::VectorXd multipliers = Eigen::VectorXd::Random(given);
      CHECK((project_by_rows(constraints, from, multipliers, {}) - point).norm() < 1e-7);
      CHECK((multipliers - expected).norm() < 1e-7);
    }
  }
}

TEST_CASE("row projection: sets that switch between matrix and rows, and drop some, satisfy all constraints") {
  std::mt19937 random(7);
  const Index count = 200;
  const Eigen::VectorXd weights = Eigen::VectorXd::Ones(count);
  ConstraintSet set;
  const Controls from = Controls::Random(count, 3);
  for (const int more : {5, 95, 3}) {  // 3 * 8 multiplications per row: by rows if there are at least 25
    std::vector<ControlConstraint> added;
    for (int r = 0; r < more; ++r) added.push_back(random_constraint(random, count, 4, weights));
    set.add(added);
    const Controls p = set.project(from, Execution(1));
    for (const ControlConstraint& constraint : added) CHECK(product(constraint.row, p) >= constraint.bound - 1e-7);
    set.drop_inactive();
    CHECK((set.project(from, Execution(1)) - p).norm() < 1e-7);
  }
}
