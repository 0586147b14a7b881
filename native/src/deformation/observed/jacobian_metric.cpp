// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/observed/jacobian_metric.hpp"

#include <array>
#include <cmath>
#include <utility>

#include "deformation/checks.hpp"
#include "deformation/metric/inverse_columns.hpp"

namespace stiv {

namespace {

/// Up to this number of coordinates, J'GJ is inverted as it is. Beyond, couplings of different axes are neglected,
/// which are zero for weights and for reflections, and small where neighboring blocks are alike.
constexpr Index most_coupled_coordinates = 600;

/// Relative to the damping: entries of J'GJ that are left out before it is factored.
constexpr double negligible_coupling = 0.005;

/// Relative to the largest entry of a column of the inverse.
constexpr double negligible_response = 1e-4;

/// Response weights of coordinates, (3 m).
Eigen::VectorXd coordinate_weights(const ResponseWeights& weights) {
  const Index count = static_cast<Index>(weights.values.rows());
  Eigen::VectorXd of_coordinates(3 * count);
  for (Index control = 0; control < count; ++control)
    for (Index axis = 0; axis < 3; ++axis)
      of_coordinates[3 * control + axis] = weights.values(control, weights.are_uniform() ? 0 : axis);
  return of_coordinates;
}

/// Some coordinates, and the damped part of J'GJ that couples them.
struct Coordinates {
  std::vector<Index> coordinate;
  std::shared_ptr<const InverseColumns> inverse;
};

class JacobianMetric final : public Metric {
 public:
  JacobianMetric(const Eigen::VectorXd& weights, std::vector<Eigen::Matrix3d> axes)
      : root_(weights.cwiseSqrt()),
        axes_(std::move(axes)),
        part_(static_cast<std::size_t>(weights.size()), -1),
        place_(static_cast<std::size_t>(weights.size()), 0) {}

  void add(Coordinates part) {
    for (std::size_t place = 0; place < part.coordinate.size(); ++place) {
      part_[at(part.coordinate[place])] = static_cast<Index>(parts_.size());
      place_[at(part.coordinate[place])] = static_cast<Index>(place);
    }
    parts_.push_back(std::move(part));
  }

  SparseField apply_inverse(const ControlsView&, const SparseField& g) const override {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(root_.size());
    for (std::size_t k = 0; k < g.index.size(); ++k) {
      const Vector3 along = axes_.empty() ? g.value[k] : Vector3(axes_[at(g.index[k])].transpose() * g.value[k]);
      for (Index axis = 0; axis < 3; ++axis) add_column(3 * g.index[k] + axis, along[axis], x);
    }
    SparseField step;
    for (Index control = 0; control < root_.size() / 3; ++control) {
      const Vector3 value = x.segment<3>(3 * control).cwiseProduct(root_.segment<3>(3 * control));
      if (value.isZero(0)) continue;
      step.index.push_back(control);
      step.value.push_back(axes_.empty() ? value : Vector3(axes_[at(control)] * value));
    }
    return step;
  }

 private:
  void add_column(Index coordinate, double value, Eigen::VectorXd& x) const {
    if (value == 0 || part_[at(coordinate)] < 0) return;
    const Coordinates& part = parts_[at(part_[at(coordinate)])];
    const InverseColumns::Column& column = part.inverse->column(place_[at(coordinate)]);
    const double scaled = root_[coordinate] * value;
    for (std::size_t k = 0; k < column.row.size(); ++k)
      x[part.coordinate[at(column.row[k])]] += scaled * column.value[k];
  }

  Eigen::VectorXd root_;  ///< of the weights of coordinates
  std::vector<Eigen::Matrix3d> axes_;
  std::vector<Coordinates> parts_;
  std::vector<Index> part_, place_;  ///< of each coordinate; part -1: it does not respond
};

/// The rows and columns `chosen`, damped. Entries up to `negligible` are left out; their magnitudes are added to the
/// diagonal, so that the matrix stays positive definite.
SymmetricMatrix damped(const SymmetricMatrix& lower, const std::vector<Index>& chosen, double damping,
                       double negligible) {
  std::vector<Index> place(static_cast<std::size_t>(lower.rows()), -1);
  for (std::size_t k = 0; k < chosen.size(); ++k) place[at(chosen[k])] = static_cast<Index>(k);
  const auto size = static_cast<Index>(chosen.size());
  SymmetricMatrix result(size, size);
  Eigen::VectorXd added = Eigen::VectorXd::Constant(size, damping);
  for (Index column = 0; column < size; ++column) {
    result.startVec(column);
    for (SymmetricMatrix::InnerIterator entry(lower, chosen[at(column)]); entry; ++entry) {
      const Index row = place[at(entry.row())];
      if (row < 0) continue;
      const double magnitude = std::abs(entry.value());
      if (row == column || magnitude > negligible) {
        result.insertBack(row, column) = entry.value();
      } else {
        added[row] += magnitude;
        added[column] += magnitude;
      }
    }
  }
  result.finalize();
  for (Index k = 0; k < size; ++k) result.coeffRef(k, k) += added[k];
  return result;
}

std::shared_ptr<const InverseColumns> inverse_of(const SymmetricMatrix& lower, const std::vector<Index>& chosen,
                                                 double damping) {
  const bool is_exact = static_cast<Index>(chosen.size()) <= most_coupled_coordinates;
  return std::make_shared<InverseColumns>(damped(lower, chosen, damping, is_exact ? 0 : negligible_coupling * damping),
                                          is_exact ? 0 : negligible_response);
}

/// Those with a weight and a derivative.
std::vector<Index> responding(const Eigen::VectorXd& diagonal, const Eigen::VectorXd& weights) {
  std::vector<Index> chosen;
  for (Index k = 0; k < diagonal.size(); ++k)
    if (diagonal[k] > 0 && weights[k] > 0) chosen.push_back(k);
  return chosen;
}

double mean(const Eigen::VectorXd& values, const std::vector<Index>& chosen) { return values(chosen).mean(); }

/// All coordinates, coupled.
void add_coupled(JacobianMetric& metric, const SymmetricMatrix& gram, const Eigen::VectorXd& weights,
                 double smoothness) {
  std::vector<Index> chosen = responding(gram.diagonal(), weights);
  if (chosen.empty()) return;
  auto inverse = inverse_of(gram, chosen, smoothness * mean(gram.diagonal(), chosen));
  metric.add({std::move(chosen), std::move(inverse)});
}

/// The coordinates of each axis by themselves. Axes with equal matrices and weights share an inverse.
void add_by_axes(JacobianMetric& metric, const std::array<SymmetricMatrix, 3>& grams, const Eigen::VectorXd& weights,
                 double smoothness, bool are_alike) {
  using ByAxis = Eigen::Map<const Eigen::VectorXd, 0, Eigen::InnerStride<3>>;
  const Index count = static_cast<Index>(weights.size()) / 3;
  std::array<std::shared_ptr<const InverseColumns>, 3> inverses;
  for (Index axis = 0; axis < 3; ++axis) {
    const SymmetricMatrix& gram = grams[are_alike ? 0 : at(axis)];
    const Eigen::VectorXd of_axis = ByAxis(weights.data() + axis, count), diagonal = gram.diagonal();
    std::vector<Index> chosen = responding(diagonal, of_axis);
    if (chosen.empty()) continue;
    for (Index before = 0; are_alike && before < axis; ++before)
      if (of_axis == ByAxis(weights.data() + before, count)) inverses[at(axis)] = inverses[at(before)];
    if (!inverses[at(axis)]) inverses[at(axis)] = inverse_of(gram, chosen, smoothness * mean(diagonal, chosen));
    for (Index& control : chosen) control = 3 * control + axis;
    metric.add({std::move(chosen), inverses[at(axis)]});
  }
}

void add_parts(JacobianMetric& metric, const JacobianProducts& jacobian, const Eigen::VectorXd& weights,
               double smoothness, const WeightMatrix* surface_gram) {
  if (!jacobian.has_blocks())
    add_by_axes(metric, {jacobian.mean_gram(surface_gram)}, weights, smoothness, true);
  else if (static_cast<Index>(weights.size()) <= most_coupled_coordinates)
    add_coupled(metric, jacobian.block_gram(surface_gram), weights, smoothness);
  else
    add_by_axes(metric, jacobian.axis_grams(surface_gram), weights, smoothness, false);
}

/// The Jacobian by coordinates along the axes of each control.
Jacobian along_axes(const Jacobian& jacobian, const std::vector<Eigen::Matrix3d>& axes) {
  Jacobian turned = jacobian;
  for (std::size_t entry = 0; entry < turned.blocks.size(); ++entry)
    turned.blocks[entry] *= axes[at(turned.weights.innerIndexPtr()[entry])];
  return turned;
}

}  // namespace

std::unique_ptr<Metric> make_jacobian_metric(const JacobianProducts& jacobian, const MetricOptions& options,
                                             const WeightMatrix* surface_gram) {
  ResponseWeights response = checked_weights(options, jacobian.control_count());
  const Eigen::VectorXd weights = coordinate_weights(response);
  if (jacobian.has_blocks() && !response.axes.empty()) {
    const JacobianProducts turned(along_axes(jacobian.jacobian(), response.axes));
    auto metric = std::make_unique<JacobianMetric>(weights, std::move(response.axes));
    add_parts(*metric, turned, weights, options.smoothness, surface_gram);
    return metric;
  }
  auto metric = std::make_unique<JacobianMetric>(weights, std::move(response.axes));
  add_parts(*metric, jacobian, weights, options.smoothness, surface_gram);
  return metric;
}

}  // namespace stiv
