// SPDX-License-Identifier: GPL-3.0-or-later
#include "response/add_multiple.hpp"

#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "response/add_multiple.cpp"
#include "vector/foreach_target.hpp"  // first: it includes this file again

#include "vector/doubles-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace stiv::HWY_NAMESPACE {

void add_multiple(double* y, double factor, const double* x, std::size_t count) {
  const Doubles d;
  const std::size_t lanes = hn::Lanes(d);
  const auto f = hn::Set(d, factor);
  std::size_t k = 0;
  for (; k + lanes <= count; k += lanes)
    hn::StoreU(hn::Add(hn::LoadU(d, y + k), hn::Mul(f, hn::LoadU(d, x + k))), d, y + k);
  for (; k < count; ++k) y[k] += factor * x[k];
}

}  // namespace stiv::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace stiv {

void add_multiple(Eigen::VectorXd& y, double factor, const double* x) {
  STIV_FOR_VECTOR_TARGET(add_multiple)(y.data(), factor, x, static_cast<std::size_t>(y.size()));
}

}  // namespace stiv
#endif
