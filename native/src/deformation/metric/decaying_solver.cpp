// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/metric/decaying_solver.hpp"

#include <algorithm>

namespace stiv {

namespace {

/// Rows that border a subtree have a smaller bound, because a solution can grow from them.
constexpr double border_fraction = 0.25;

}  // namespace

DecayingSolver::DecayingSolver(const SparseFactor& factor, double negligible)
    : factor_(factor), negligible_(negligible), pivots_(factor.pivots()) {
  const auto size = static_cast<std::size_t>(factor.size());
  for (Index column = 0; column < factor.size(); ++column) parent_.push_back(factor.parent(column));
  x_.assign(size, Row::Zero());
  on_path_.assign(size, 0);
  is_large_.assign(size, 0);
  visits_children_.assign(size, 0);
}

void DecayingSolver::add_to_path(const BlockRow& right) {
  const Index place = factor_.place(right.row);
  x_[at(place)] += right.values;
  for (Index column = place; column >= 0; column = parent_[at(column)]) {
    if (on_path_[at(column)] != 0) return;
    on_path_[at(column)] = 1;
    path_.push_back(column);
  }
}

void DecayingSolver::substitute_forward() {
  for (const Index column : path_) {
    const Row known = x_[at(column)];
    for (SymmetricMatrix::InnerIterator entry(factor_.lower(), column); entry; ++entry)
      x_[at(entry.row())] -= entry.value() * known;
  }
}

void DecayingSolver::substitute_backward(Index column) {
  Row sum = x_[at(column)] / pivots_[column];
  for (SymmetricMatrix::InnerIterator entry(factor_.lower(), column); entry; ++entry)
    sum -= entry.value() * x_[at(entry.row())];
  x_[at(column)] = sum;
}

/// Returns the largest entry of each column.
DecayingSolver::Row DecayingSolver::solve_path() {
  Row largest = Row::Zero();
  for (auto column = path_.rbegin(); column != path_.rend(); ++column) {
    substitute_backward(*column);
    largest = largest.max(x_[at(*column)].abs());
  }
  return largest;
}

/// Do the subtrees below a column depend on a row that is not negligible?
bool DecayingSolver::borders_something(Index column) const {
  if (is_large_[at(column)] != 0) return true;
  for (SymmetricMatrix::InnerIterator entry(factor_.lower(), column); entry; ++entry)
    if (is_large_[at(entry.row())] != 0) return true;
  return false;
}

std::vector<BlockRow> DecayingSolver::solve_beside_path(const Row& negligible) {
  std::vector<BlockRow> rows;
  for (Index column = factor_.size() - 1; column >= 0; --column) {
    const std::size_t k = at(column);
    const Index parent = parent_[k];
    if (on_path_[k] == 0) {
      if (parent < 0 || visits_children_[at(parent)] == 0) continue;
      substitute_backward(column);
    }
    solved_.push_back(column);
    const Row size = x_[k].abs();
    is_large_[k] = (size > border_fraction * negligible).any() ? 1 : 0;
    visits_children_[k] = borders_something(column) ? 1 : 0;
    if ((size > negligible).any()) rows.push_back({factor_.row(column), (size > negligible).select(x_[k], 0)});
  }
  return rows;
}

void DecayingSolver::clear() {
  for (const Index column : solved_) {
    const std::size_t k = at(column);
    x_[k].setZero();
    on_path_[k] = is_large_[k] = visits_children_[k] = 0;
  }
  path_.clear();
  solved_.clear();
}

std::vector<BlockRow> DecayingSolver::solve(const std::vector<BlockRow>& right) {
  for (const BlockRow& row : right) add_to_path(row);
  std::sort(path_.begin(), path_.end());
  substitute_forward();
  const Row largest = solve_path();
  std::vector<BlockRow> rows = solve_beside_path(negligible_ * largest);
  clear();
  return rows;
}

}  // namespace stiv
