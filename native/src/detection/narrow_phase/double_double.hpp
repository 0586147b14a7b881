// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace stiv {

/// A number as the unevaluated sum of two doubles: about 106 bits, for the few decisions that doubles leave open.
/// Source of the algorithms and of their error bounds: Joldes, Muller, Popescu, Tight and rigorous error bounds for
/// basic building blocks of double-word arithmetic, 2017 (sums 3 u^2, products and quotients below 16 u^2, u = 2^-53).
struct DoubleDouble {
  double high = 0;
  double low = 0;

  DoubleDouble() = default;
  DoubleDouble(double value) : high(value) {}
  DoubleDouble(int value) : high(value) {}
  DoubleDouble(double a, double b) : high(a), low(b) {}

  DoubleDouble& operator+=(const DoubleDouble& other) { return *this = *this + other; }
  DoubleDouble& operator-=(const DoubleDouble& other) { return *this = *this - other; }
  DoubleDouble& operator*=(const DoubleDouble& other) { return *this = *this * other; }
  DoubleDouble& operator/=(const DoubleDouble& other) { return *this = *this / other; }

  friend DoubleDouble operator-(const DoubleDouble& a) { return {-a.high, -a.low}; }
  friend DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
    const DoubleDouble highs = sum(a.high, b.high), lows = sum(a.low, b.low);
    const DoubleDouble head = ordered_sum(highs.high, highs.low + lows.high);
    return ordered_sum(head.high, lows.low + head.low);
  }
  friend DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) { return a + -b; }
  friend DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
    const DoubleDouble head = product(a.high, b.high);
    return ordered_sum(head.high, head.low + (a.high * b.low + a.low * b.high));
  }
  friend DoubleDouble operator/(const DoubleDouble& a, const DoubleDouble& b) {
    const double first = a.high / b.high;
    const DoubleDouble rest = a - b * DoubleDouble(first);
    return ordered_sum(first, rest.high / b.high);
  }
  friend DoubleDouble sqrt(const DoubleDouble& a) {
    if (!(a.high > 0)) return 0.0;
    const double root = std::sqrt(a.high);
    const DoubleDouble rest = a - product(root, root);
    return ordered_sum(root, rest.high / (2 * root));
  }
  friend DoubleDouble abs(const DoubleDouble& a) { return a.high < 0 ? -a : a; }

  friend bool operator==(const DoubleDouble& a, const DoubleDouble& b) = default;
  friend bool operator<(const DoubleDouble& a, const DoubleDouble& b) {
    return a.high < b.high || (a.high == b.high && a.low < b.low);
  }
  friend bool operator>(const DoubleDouble& a, const DoubleDouble& b) { return b < a; }
  friend bool operator<=(const DoubleDouble& a, const DoubleDouble& b) { return a < b || a == b; }
  friend bool operator>=(const DoubleDouble& a, const DoubleDouble& b) { return b <= a; }

 private:
  /// a + b without error [Knuth].
  static DoubleDouble sum(double a, double b) {
    const double s = a + b, part = s - a;
    return {s, (a - (s - part)) + (b - part)};
  }
  /// The same where |a| >= |b| or a = 0 [Dekker].
  static DoubleDouble ordered_sum(double a, double b) {
    const double s = a + b;
    return {s, b - (s - a)};
  }
  /// a b without error [Dekker, Veltkamp], up to underflow.
  static DoubleDouble product(double a, double b) {
    const DoubleDouble x = split(a), y = split(b);
    const double p = a * b;
    return {p, ((x.high * y.high - p) + x.high * y.low + x.low * y.high) + x.low * y.low};
  }
  static DoubleDouble split(double a) {
    const double c = 0x1.0000002p27 * a, high = c - (c - a);
    return {high, a - high};
  }
};

/// Error bounds of the narrow phase for a type of numbers.
template <class Scalar>
struct Precision;

template <>
struct Precision<double> {
  /// Bound of the rounding error of a projected gap, over the pair's largest coordinate: 128 u.
  static constexpr double gap = 0x1p-46;
  /// Below this multiple of `gap`, the direction between closest points is uncertain by more than their distance over
  /// the pair's size: about the square root of u.
  static constexpr double noise = 0x1p24;
  /// Steps of one advancement. Contacts take 2 to 6; those that touch without crossing take a fixed fraction of the
  /// wait at each.
  static constexpr int most_steps = 256;
  /// Trials of a longer step in each step. If a triangle turns by a large angle beside another, a plane may have to
  /// turn in hundreds of parts of the step: each is valid as long as (angle)^2 times the size stays below the gap.
  static constexpr int most_trials = 12;
  static constexpr int trials_in_all = 1024;
};

template <>
struct Precision<DoubleDouble> {
  /// No operation errs by more than 16 u^2, u = 2^-53, so 2^-102 replaces u.
  static constexpr double gap = 0x1p-95;
  static constexpr double noise = 0x1p48;
  static constexpr int most_steps = 24;
  static constexpr int most_trials = 4;
  static constexpr int trials_in_all = 64;
};

}  // namespace stiv

template <>
struct Eigen::NumTraits<stiv::DoubleDouble> : Eigen::NumTraits<double> {
  using Real = stiv::DoubleDouble;
  using NonInteger = stiv::DoubleDouble;
  using Nested = stiv::DoubleDouble;
  using Literal = double;
  enum { RequireInitialization = 1, ReadCost = 2, AddCost = 20, MulCost = 30 };
};
