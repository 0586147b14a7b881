// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/handles/anderson.hpp"

#include <Eigen/Cholesky>
#include <utility>

namespace stiv {

namespace {

constexpr std::size_t window = 10;
constexpr double damping = 1e-13;  // relative to the mean of the diagonal, for nearly dependent residuals

double dot(const Positions& a, const Positions& b) { return a.cwiseProduct(b).sum(); }

}  // namespace

/// Appends to the last few differences and to their products.
void AndersonAcceleration::add(Difference difference) {
  differences_.push_back(std::move(difference));
  if (differences_.size() > window) {
    differences_.pop_front();
    products_ = Eigen::MatrixXd(products_.bottomRightCorner(window - 1, window - 1));
  }
  const auto count = static_cast<Eigen::Index>(differences_.size());
  products_.conservativeResize(count, count);
  for (Eigen::Index k = 0; k < count; ++k)
    products_(k, count - 1) = products_(count - 1, k) = dot(differences_[at(k)].residual, differences_.back().residual);
}

Positions AndersonAcceleration::next(const Positions& x, const Positions& g) {
  const Positions residual = g - x;
  if (has_last_) add({residual - last_residual_, g - last_image_});
  last_residual_ = residual;
  last_image_ = g;
  has_last_ = true;
  const auto count = static_cast<Index>(differences_.size());
  if (count == 0) return g;
  Eigen::VectorXd right(count);
  for (Index k = 0; k < count; ++k) right[k] = dot(differences_[at(k)].residual, residual);
  Eigen::MatrixXd products = products_;
  products.diagonal().array() += damping * products.diagonal().mean();
  const Eigen::VectorXd share = products.ldlt().solve(right);
  Positions result = g;
  if (!share.allFinite()) return result;
  for (Index k = 0; k < count; ++k) result -= share[k] * differences_[at(k)].image;
  return result;
}

}  // namespace stiv
