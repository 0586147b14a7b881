// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>

namespace stiv {

/// An integer of up to 640 bits: sign and magnitude, in digits of 32 bits, the lowest first. Schoolbook arithmetic on
/// 64-bit integers alone, so that it shares nothing with what it tests.
class WideInteger {
 public:
  static constexpr int capacity = 20;

  WideInteger() = default;

  /// value * 2^-exponent, which must be an integer.
  WideInteger(double value, int exponent) {
    int own = 0;
    const double fraction = std::frexp(value, &own);  // 53 bits: fraction * 2^53 is an integer
    auto mantissa = static_cast<std::uint64_t>(std::abs(std::ldexp(fraction, 53)));
    negative_ = value < 0;
    int shift = own - 53 - exponent;
    for (; mantissa != 0 && shift < 0; ++shift) {
      if ((mantissa & 1U) != 0) std::abort();
      mantissa >>= 1;
    }
    for (int bit = 0; mantissa != 0; ++bit, mantissa >>= 1)
      if ((mantissa & 1U) != 0) set_bit(bit + shift);
  }

  int sign() const { return size_ == 0 ? 0 : (negative_ ? -1 : 1); }

  friend WideInteger operator-(WideInteger a) {
    a.negative_ = !a.negative_;
    return a;
  }
  friend WideInteger operator-(const WideInteger& a, const WideInteger& b) { return a + -b; }

  friend WideInteger operator+(const WideInteger& a, const WideInteger& b) {
    if (a.negative_ == b.negative_) return sum_of_magnitudes(a, b);
    return larger_magnitude(a, b) ? difference_of_magnitudes(a, b) : difference_of_magnitudes(b, a);
  }

  friend WideInteger operator*(const WideInteger& a, const WideInteger& b) {
    if (a.size_ + b.size_ > capacity) std::abort();
    WideInteger product;
    product.negative_ = a.negative_ != b.negative_;
    for (int i = 0; i < a.size_; ++i) {
      std::uint64_t carry = 0;
      for (int j = 0; j < b.size_; ++j) {
        const std::uint64_t sum = a.at(i) * b.at(j) + product.at(i + j) + carry;
        product.set(i + j, sum);
        carry = sum >> 32;
      }
      product.set(i + b.size_, carry);
    }
    product.trim(a.size_ + b.size_);
    return product;
  }

 private:
  std::uint64_t at(int k) const { return digit_[static_cast<std::size_t>(k)]; }
  void set(int k, std::uint64_t value) { digit_[static_cast<std::size_t>(k)] = static_cast<std::uint32_t>(value); }

  void set_bit(int bit) {
    if (bit / 32 >= capacity) std::abort();
    set(bit / 32, at(bit / 32) | (std::uint64_t{1} << (bit % 32)));
    size_ = std::max(size_, bit / 32 + 1);
  }

  void trim(int size) {
    while (size > 0 && at(size - 1) == 0) --size;
    size_ = size;
  }

  static bool larger_magnitude(const WideInteger& a, const WideInteger& b) {
    if (a.size_ != b.size_) return a.size_ > b.size_;
    for (int k = a.size_ - 1; k >= 0; --k)
      if (a.at(k) != b.at(k)) return a.at(k) > b.at(k);
    return false;
  }

  static WideInteger sum_of_magnitudes(const WideInteger& a, const WideInteger& b) {
    WideInteger sum;
    sum.negative_ = a.negative_;
    const int size = std::max(a.size_, b.size_);
    std::uint64_t carry = 0;
    for (int k = 0; k < size; ++k) {
      carry += a.at(k) + b.at(k);
      sum.set(k, carry);
      carry >>= 32;
    }
    if (carry != 0 && size == capacity) std::abort();
    if (carry != 0) sum.set(size, carry);
    sum.trim(std::min(size + 1, capacity));
    return sum;
  }

  /// |a| - |b| with the sign of a, for |a| >= |b|.
  static WideInteger difference_of_magnitudes(const WideInteger& a, const WideInteger& b) {
    WideInteger difference;
    difference.negative_ = a.negative_;
    std::uint64_t borrow = 0;
    for (int k = 0; k < a.size_; ++k) {
      const std::uint64_t left = a.at(k), right = b.at(k) + borrow;
      borrow = left < right ? 1 : 0;
      difference.set(k, left + (borrow << 32) - right);
    }
    difference.trim(a.size_);
    return difference;
  }

  std::array<std::uint32_t, capacity> digit_{};
  int size_ = 0;
  bool negative_ = false;
};

}  // namespace stiv
