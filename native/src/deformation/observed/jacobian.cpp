// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/observed/jacobian.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "deformation/checks.hpp"
#include "deformation/linear/weight_rows.hpp"
#include "stiv/error.hpp"

namespace stiv {

namespace {

/// Sums by index, of which few are touched at a time.
template <class Value>
class TouchedSums {
 public:
  TouchedSums(Index count, const Value& zero)
      : zero_(zero), sums_(static_cast<std::size_t>(count), zero), is_touched_(static_cast<std::size_t>(count), 0) {}

  Value& operator[](Index index) {
    if (is_touched_[at(index)] == 0) touched_.push_back(index);
    is_touched_[at(index)] = 1;
    return sums_[at(index)];
  }

  /// Calls `use(index, sum)` in ascending order, and sets all sums to zero.
  template <class Use>
  void drain(const Use& use) {
    std::sort(touched_.begin(), touched_.end());
    for (const Index index : touched_) {
      use(index, std::as_const(sums_[at(index)]));
      sums_[at(index)] = zero_;
      is_touched_[at(index)] = 0;
    }
    touched_.clear();
  }

 private:
  Value zero_;
  std::vector<Value> sums_;
  std::vector<unsigned char> is_touched_;
  std::vector<Index> touched_;
};

/// Calls `use(control, entry)` for the entries of a row.
template <class Use>
void for_entries(const WeightMatrix& rows, Index row, const Use& use) {
  for (Index entry = rows.outerIndexPtr()[row]; entry < rows.outerIndexPtr()[row + 1]; ++entry)
    use(rows.innerIndexPtr()[entry], entry);
}

Eigen::Matrix3d block_of(const Jacobian& jacobian, Index entry) {
  if (!jacobian.blocks.empty()) return jacobian.blocks[at(entry)];
  return jacobian.weights.valuePtr()[entry] * Eigen::Matrix3d::Identity();
}

/// Appends the columns of a sparse matrix, rows ascending.
class ColumnWriter {
 public:
  void add(Index row, double value) {
    rows_.push_back(row);
    values_.push_back(value);
  }
  void end_column() { starts_.push_back(static_cast<Index>(rows_.size())); }
  /// Square, of the columns that ended.
  SymmetricMatrix matrix() const {
    const auto size = static_cast<Index>(starts_.size()) - 1;
    return Eigen::Map<const SymmetricMatrix>(size, size, static_cast<Index>(rows_.size()), starts_.data(), rows_.data(),
                                             values_.data());
  }

 private:
  std::vector<Index> starts_{0}, rows_;
  std::vector<double> values_;
};

}  // namespace

Jacobian jacobian_from_blocks(const std::vector<Index>& starts, const std::vector<Index>& controls,
                              const std::vector<Eigen::Matrix3d>& blocks, Index control_count) {
  Jacobian jacobian;
  jacobian.weights = weights_from_rows(starts, controls, std::vector<double>(blocks.size(), 1), control_count);
  TouchedSums<Eigen::Matrix3d> sums(control_count, Eigen::Matrix3d::Zero());
  for (std::size_t row = 0; row + 1 < starts.size(); ++row) {
    for (Index k = starts[row]; k < starts[row + 1]; ++k) sums[controls[at(k)]] += blocks[at(k)];
    sums.drain([&](Index, const Eigen::Matrix3d& sum) { jacobian.blocks.push_back(sum); });
  }
  return jacobian;
}

void check_jacobian(const Jacobian& jacobian) {
  for (Index row = 0; row < jacobian.weights.rows(); ++row)
    for_entries(jacobian.weights, row, [&](Index control, Index entry) {
      if (!block_of(jacobian, entry).allFinite())
        throw InputError("jacobian, row " + std::to_string(row) + ", control " + std::to_string(control) +
                         ": a number is not finite");
    });
}

JacobianProducts::JacobianProducts(Jacobian jacobian)
    : jacobian_(std::move(jacobian)), column_starts_(static_cast<std::size_t>(jacobian_.weights.cols()) + 1, 0) {
  const WeightMatrix& rows = jacobian_.weights;
  for (Index entry = 0; entry < rows.nonZeros(); ++entry) ++column_starts_[at(rows.innerIndexPtr()[entry]) + 1];
  for (std::size_t column = 1; column < column_starts_.size(); ++column)
    column_starts_[column] += column_starts_[column - 1];
  std::vector<Index> next(column_starts_.begin(), column_starts_.end() - 1);
  column_rows_.resize(static_cast<std::size_t>(rows.nonZeros()));
  column_entries_.resize(column_rows_.size());
  for (Index row = 0; row < vertex_count(); ++row)
    for_entries(rows, row, [&](Index control, Index entry) {
      const std::size_t place = at(next[at(control)]++);
      column_rows_[place] = row;
      column_entries_[place] = entry;
    });
}

SparseField JacobianProducts::pull_back(const SparseField& g) const {
  TouchedSums<Vector3> sums(control_count(), Vector3::Zero());
  for (std::size_t k = 0; k < g.index.size(); ++k)
    for_entries(jacobian_.weights, g.index[k], [&](Index control, Index entry) {
      if (has_blocks())
        sums[control] += jacobian_.blocks[at(entry)].transpose() * g.value[k];
      else
        sums[control] += jacobian_.weights.valuePtr()[entry] * g.value[k];
    });
  SparseField pulled;
  sums.drain([&](Index control, const Vector3& sum) {
    pulled.index.push_back(control);
    pulled.value.push_back(sum);
  });
  return pulled;
}

Positions JacobianProducts::push_forward(const Controls& d) const {
  check_control_rows(d, control_count());
  Positions velocity = Positions::Zero(vertex_count(), 3);
  for (Index row = 0; row < vertex_count(); ++row)
    for_entries(jacobian_.weights, row, [&](Index control, Index entry) {
      velocity.row(row) += (block_of(jacobian_, entry) * d.row(control).transpose()).transpose();
    });
  return velocity;
}

std::vector<Index> JacobianProducts::support(Index control) const {
  const auto begin = column_rows_.begin();
  return {begin + column_starts_[at(control)], begin + column_starts_[at(control) + 1]};
}

/// Calls `use(d, weight, a, b)` for each term weight * block(a)' block(b) of J'GJ at (d, column), d >= column.
template <class Use>
void JacobianProducts::for_gram_terms(Index column, const WeightMatrix* surface_gram, const Use& use) const {
  const auto row_terms = [&](Index row, double weight, Index b) {
    for_entries(jacobian_.weights, row, [&](Index d, Index a) {
      if (d >= column) use(d, weight, a, b);
    });
  };
  for (Index place = column_starts_[at(column)]; place < column_starts_[at(column) + 1]; ++place) {
    const Index row = column_rows_[at(place)], b = column_entries_[at(place)];
    if (surface_gram == nullptr) {
      row_terms(row, 1, b);
    } else {
      for (WeightMatrix::InnerIterator entry(*surface_gram, row); entry; ++entry)
        row_terms(static_cast<Index>(entry.col()), entry.value(), b);
    }
  }
}

SymmetricMatrix JacobianProducts::mean_gram(const WeightMatrix* surface_gram) const {
  ColumnWriter writer;
  TouchedSums<double> sums(control_count(), 0);
  const std::vector<Eigen::Matrix3d>& blocks = jacobian_.blocks;
  const double* const weights = jacobian_.weights.valuePtr();
  for (Index column = 0; column < control_count(); ++column) {
    for_gram_terms(column, surface_gram, [&](Index d, double weight, Index a, Index b) {
      sums[d] +=
          weight * (has_blocks() ? blocks[at(a)].cwiseProduct(blocks[at(b)]).sum() / 3 : weights[a] * weights[b]);
    });
    sums.drain([&](Index d, double sum) { writer.add(d, sum); });
    writer.end_column();
  }
  return writer.matrix();
}

std::array<SymmetricMatrix, 3> JacobianProducts::axis_grams(const WeightMatrix* surface_gram) const {
  std::array<ColumnWriter, 3> writers;
  TouchedSums<Vector3> sums(control_count(), Vector3::Zero());
  for (Index column = 0; column < control_count(); ++column) {
    for_gram_terms(column, surface_gram, [&](Index d, double weight, Index a, Index b) {
      sums[d] += weight * block_of(jacobian_, a).cwiseProduct(block_of(jacobian_, b)).colwise().sum().transpose();
    });
    sums.drain([&](Index d, const Vector3& sum) {
      for (Index axis = 0; axis < 3; ++axis) writers[at(axis)].add(d, sum[axis]);
    });
    for (ColumnWriter& writer : writers) writer.end_column();
  }
  return {writers[0].matrix(), writers[1].matrix(), writers[2].matrix()};
}

SymmetricMatrix JacobianProducts::block_gram(const WeightMatrix* surface_gram) const {
  ColumnWriter writer;
  TouchedSums<Eigen::Matrix3d> sums(control_count(), Eigen::Matrix3d::Zero());
  std::vector<std::pair<Index, Eigen::Matrix3d>> column_blocks;
  for (Index column = 0; column < control_count(); ++column) {
    for_gram_terms(column, surface_gram, [&](Index d, double weight, Index a, Index b) {
      sums[d] += weight * (block_of(jacobian_, a).transpose() * block_of(jacobian_, b));
    });
    column_blocks.clear();
    sums.drain([&](Index d, const Eigen::Matrix3d& sum) { column_blocks.emplace_back(d, sum); });
    for (Index b = 0; b < 3; ++b) {
      for (const auto& [d, block] : column_blocks)
        for (Index a = d == column ? b : 0; a < 3; ++a) writer.add(3 * d + a, block(a, b));
      writer.end_column();
    }
  }
  return writer.matrix();
}

Jacobian product(const Jacobian& outer, const Jacobian& inner) {
  const auto controls = static_cast<Index>(inner.weights.cols());
  Jacobian result;
  if (outer.blocks.empty() && inner.blocks.empty()) {
    result.weights = weight_product(outer.weights, inner.weights);
    return result;
  }
  std::vector<Index> starts{0}, columns;
  std::vector<Eigen::Matrix3d> blocks;
  TouchedSums<Eigen::Matrix3d> sums(controls, Eigen::Matrix3d::Zero());
  for (Index row = 0; row < outer.weights.rows(); ++row) {
    for_entries(outer.weights, row, [&](Index middle, Index a) {
      for_entries(inner.weights, middle,
                  [&](Index control, Index b) { sums[control] += block_of(outer, a) * block_of(inner, b); });
    });
    sums.drain([&](Index control, const Eigen::Matrix3d& sum) {
      columns.push_back(control);
      blocks.push_back(sum);
    });
    starts.push_back(static_cast<Index>(columns.size()));
  }
  return jacobian_from_blocks(starts, columns, blocks, controls);
}

}  // namespace stiv
