// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stiv/types.hpp"

namespace stiv {

inline double squared_norm(const SparseField& field) {
  double sum = 0;
  for (const Vector3& value : field.value) sum += value.squaredNorm();
  return sum;
}

/// Product of two sparse fields; both are ascending.
inline double dot(const SparseField& a, const SparseField& b) {
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
