// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>

#include "stiv/types.hpp"

namespace stiv {

inline double squared_norm(const SparseField& field) {
  double sum = 0;
  for (const Vector3& value : field.value) sum += value.squaredNorm();
  return sum;
}

/// Dot product of a sparse field and one with consecutive indices, the result of a metric that couples all controls.
inline double dot_with_run(const SparseField& a, const SparseField& run) {
  double sum = 0;
  const Index first = run.index.front();
  const auto begin = std::lower_bound(a.index.begin(), a.index.end(), first);
  for (auto k = static_cast<std::size_t>(begin - a.index.begin()); k < a.index.size(); ++k) {
    if (a.index[k] > run.index.back()) break;
    sum += a.value[k].dot(run.value[at(a.index[k] - first)]);
  }
  return sum;
}

/// Dot product of two sparse fields. Terms are added in the order of indices in both branches.
inline double dot(const SparseField& a, const SparseField& b) {
  const std::size_t size = b.index.size();
  if (size > 0 && static_cast<std::size_t>(b.index.back() - b.index.front()) + 1 == size) return dot_with_run(a, b);
  double sum = 0;
  for (std::size_t i = 0, j = 0; i < a.index.size() && j < b.index.size();) {
    if (a.index[i] == b.index[j])
      sum += a.value[i++].dot(b.value[j++]);
    else if (a.index[i] < b.index[j])
      ++i;
    else
      ++j;
  }
  return sum;
}

inline double dot(const SparseField& a, const Controls& p) {
  double sum = 0;
  for (std::size_t k = 0; k < a.index.size(); ++k) sum += a.value[k].dot(p.row(a.index[k]).transpose());
  return sum;
}

inline void add_scaled(Controls& p, double factor, const SparseField& field) {
  for (std::size_t k = 0; k < field.index.size(); ++k) p.row(field.index[k]) += factor * field.value[k].transpose();
}

inline void scale(SparseField& field, double factor) {
  for (Vector3& value : field.value) value *= factor;
}

}  // namespace stiv
