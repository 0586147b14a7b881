// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/narrow_phase/bernstein.hpp"

#include <cmath>

namespace stiv {

namespace {

constexpr int deepest = 40;
constexpr int most_refinements = 100;

template <std::size_t size>
int sign_changes(const std::array<double, size>& b) {
  int changes = 0;
  double last = 0;
  for (const double value : b) {
    changes += last * value < 0 || (last != 0 && value != 0 && std::signbit(last) != std::signbit(value));
    if (value != 0) last = value;
  }
  return changes;
}

/// Replaces b by its restriction to the lower half and returns the restriction to the upper half. [de Casteljau]
template <std::size_t size>
std::array<double, size> split(std::array<double, size>& b) {
  std::array<double, size> upper;
  for (std::size_t k = size; k-- > 0;) {
    upper[k] = b[size - 1];
    for (std::size_t i = size - 1; i >= size - k; --i) b[i] = (b[i - 1] + b[i]) / 2;
  }
  return upper;
}

template <std::size_t size>
double value(std::array<double, size> b, double t) {
  for (std::size_t k = size - 1; k > 0; --k)
    for (std::size_t i = 0; i < k; ++i) b[i] = (1 - t) * b[i] + t * b[i + 1];
  return b[0];
}

/// The root between two ends of different sign, by false position that halves the weight of an end that stays
/// [Illinois], and by bisection if that is slow.
template <std::size_t size>
double bracketed_root(const std::array<double, size>& b) {
  double low = 0, high = 1, at_low = b.front(), at_high = b.back();
  for (int k = 0; k < most_refinements && high - low > 0x1p-53; ++k) {
    double t = k % 4 == 3 ? (low + high) / 2 : low + (high - low) * (at_low / (at_low - at_high));
    if (!(t > low && t < high)) t = (low + high) / 2;
    if (!(t > low && t < high)) break;
    const double middle = value(b, t);
    if (middle == 0) return t;
    if (std::signbit(middle) == std::signbit(b.front())) {
      low = t;
      at_low = middle;
      at_high /= 2;
    } else {
      high = t;
      at_high = middle;
      at_low /= 2;
    }
  }
  return (low + high) / 2;
}

template <std::size_t size>
void collect(std::array<double, size> b, double start, double width, int depth, std::vector<double>& found) {
  if (b.front() == 0 && (found.empty() || found.back() != start)) found.push_back(start);
  const int changes = sign_changes(b);
  if (changes == 1 && b.front() != 0 && b.back() != 0) {
    found.push_back(start + width * bracketed_root(b));
  } else if (changes > 0 && depth == deepest) {
    found.push_back(start + width / 2);
  } else if (changes > 0) {
    const std::array<double, size> upper = split(b);
    collect(b, start, width / 2, depth + 1, found);
    collect(upper, start + width / 2, width / 2, depth + 1, found);
    return;
  }
  if (b.back() == 0 && (found.empty() || found.back() != start + width)) found.push_back(start + width);
}

template <std::size_t size>
std::vector<double> all_roots(const std::array<double, size>& b) {
  std::vector<double> found;
  bool vanishes = true;
  for (const double coefficient : b) vanishes = vanishes && coefficient == 0;
  if (!vanishes) collect(b, 0, 1, 0, found);
  return found;
}

}  // namespace

std::vector<double> roots(const Bernstein<3>& polynomial) { return all_roots(polynomial); }
std::vector<double> roots(const Bernstein<6>& polynomial) { return all_roots(polynomial); }

}  // namespace stiv
