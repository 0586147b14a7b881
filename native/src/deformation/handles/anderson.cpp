// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/handles/anderson.hpp"

#include <Eigen/Cholesky>

namespace stiv {

namespace {

constexpr std::size_t window = 6;
constexpr double damping = 1e-13;  // of the mean of the squares: residuals that say the same twice

}  // namespace

Positions AndersonAcceleration::next(const Positions& x, const Positions& g) {
  const Positions residual = g - x;
  if (has_last_) differences_.push_back({residual - last_residual_, g - last_image_});
  if (differences_.size() > window) differences_.pop_front();
  last_residual_ = residual;
  last_image_ = g;
  has_last_ = true;
  const auto count = static_cast<Index>(differences_.size());
  if (count == 0) return g;
  Eigen::MatrixXd products(count, count);
  Eigen::VectorXd right(count);
  for (Index row = 0; row < count; ++row) {
    const Positions& a = differences_[at(row)].residual;
    right[row] = a.cwiseProduct(residual).sum();
    for (Index column = 0; column <= row; ++column)
      products(row, column) = products(column, row) = a.cwiseProduct(differences_[at(column)].residual).sum();
  }
  products.diagonal().array() += damping * products.diagonal().mean();
  const Eigen::VectorXd share = products.ldlt().solve(right);
  Positions result = g;
  if (!share.allFinite()) return result;
  for (Index k = 0; k < count; ++k) result -= share[k] * differences_[at(k)].image;
  return result;
}

}  // namespace stiv
