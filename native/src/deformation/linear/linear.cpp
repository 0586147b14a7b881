// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/deformation/linear.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "deformation/checks.hpp"
#include "deformation/linear/linear_metric.hpp"
#include "deformation/linear/weighted_sums.hpp"
#include "position_rows.hpp"
#include "stiv/error.hpp"

namespace stiv {

namespace {

using Entry = WeightMatrix::InnerIterator;

class Linear final : public LinearDeformation {
 public:
  Linear(const WeightMatrix& matrix, Positions offset)
      : matrix_(matrix), metrics_(matrix_), offset_(std::move(offset)) {}

  Index control_count() const override { return static_cast<Index>(matrix_.cols()); }
  Index vertex_count() const override { return static_cast<Index>(matrix_.rows()); }

  Positions surface(const Controls& p, const Execution& execution) const override {
    check_control_rows(p, control_count());
    Positions q = weighted_sums(matrix_, p, execution);
    if (offset_.rows() > 0) q += offset_;
    return q;
  }

  Positions surface_rows(const Controls& p, std::span<const Index> vertices,
                         const Execution& execution) const override {
    check_control_rows(p, control_count());
    Positions q = weighted_sums(matrix_, vertices, p, execution);
    if (offset_.rows() > 0) q += rows_of(offset_, vertices);
    return q;
  }

  SparseField pull_back(const ControlsView&, const SparseField& g) const override {
    std::vector<Vector3> sum(static_cast<std::size_t>(matrix_.cols()), Vector3::Zero());
    std::vector<Index> touched;
    std::vector<unsigned char> seen(sum.size(), 0);
    for (std::size_t k = 0; k < g.index.size(); ++k)
      for (Entry entry(matrix_, g.index[k]); entry; ++entry) {
        const auto control = static_cast<std::size_t>(entry.col());
        if (!seen[control]) touched.push_back(static_cast<Index>(entry.col()));
        seen[control] = 1;
        sum[control] += entry.value() * g.value[k];
      }
    std::sort(touched.begin(), touched.end());
    SparseField pulled;
    for (const Index control : touched) pulled.value.push_back(sum[at(control)]);
    pulled.index = std::move(touched);
    return pulled;
  }

  Positions push_forward(const Controls&, const Controls& d) const override {
    check_control_rows(d, control_count());
    return weighted_sums(matrix_, d, Execution(1));
  }

  std::unique_ptr<Metric> metric(const MetricOptions& options) const override { return metrics_.make(options); }

  const WeightMatrix& weights() const override { return matrix_; }
  const Positions& offset() const override { return offset_; }

  std::vector<Index> support(Index control) const override {
    std::vector<Index> vertices;
    for (WeightColumns::InnerIterator entry(metrics_.matrix(), control); entry; ++entry)
      if (entry.value() != 0) vertices.push_back(static_cast<Index>(entry.row()));
    return vertices;
  }

 private:
  WeightMatrix matrix_;
  LinearMetrics metrics_;
  Positions offset_;
};

void check_weights(const WeightMatrix& matrix) {
  for (Index row = 0; row < matrix.rows(); ++row)
    for (Entry entry(matrix, row); entry; ++entry)
      if (!std::isfinite(entry.value()))
        throw InputError("linear deformation, row " + std::to_string(row) + ": weight of control " +
                         std::to_string(entry.col()) + " is not finite");
}

}  // namespace

std::shared_ptr<const LinearDeformation> make_linear(WeightMatrix matrix, Positions offset) {
  if (offset.rows() != 0 && offset.rows() != matrix.rows())
    throw InputError("linear deformation: offset has " + std::to_string(offset.rows()) + " rows, the weights have " +
                     std::to_string(matrix.rows()) + "; give one row for each vertex, or none");
  check_weights(matrix);
  check_finite(offset, "linear deformation, offset of row");
  matrix.makeCompressed();
  return std::make_shared<Linear>(std::move(matrix), std::move(offset));
}

}  // namespace stiv
