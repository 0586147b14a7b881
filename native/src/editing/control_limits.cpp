// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/control_limits.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>
#include <utility>

#include "editing/limit_constraint.hpp"
#include "stiv/error.hpp"

namespace stiv {

namespace {

/// A step may exceed the longest one by rounding.
constexpr double rounding = 1 + 1e-6;

/// The number of single precision closest to `limit` on the side of `toward`.
double rounded_toward(double limit, double toward) {
  auto single = static_cast<float>(limit);
  const auto value = static_cast<double>(single);
  if (value != limit && (value < limit) != (toward < limit))
    single = std::nextafter(single, static_cast<float>(toward));
  return static_cast<double>(single);
}

bool is_stored(Index row, const std::vector<StorageFrame>& frames) {
  for (const StorageFrame& storage : frames) {
    if (row < storage.first || row >= storage.first + storage.count) continue;
    if (storage.frame.isIdentity(0)) return true;
    throw InputError("control " + std::to_string(row) +
                     " is a scalar: its storage frame must be the identity, or it must have none");
  }
  return false;
}

[[noreturn]] void refuse(Index row, double value, double lower, double upper) {
  std::ostringstream message;
  message << "control " << row << ": " << value << " is outside its limits " << lower << " to " << upper;
  throw InputError(message.str());
}

}  // namespace

ControlLimits::ControlLimits(ScalarRows scalars, const std::vector<StorageFrame>& frames)
    : scalars_(std::move(scalars)), lower_(scalars_.limits.lower), upper_(scalars_.limits.upper) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (Index k = 0; k < lower_.size(); ++k) {
    is_stored_.push_back(is_stored(rows()[at(k)], frames));
    if (is_stored_.back() == 0) continue;
    const double low = rounded_toward(lower_[k], infinity), high = rounded_toward(upper_[k], -infinity);
    if (low > high) continue;  // no number of single precision between them
    lower_[k] = low;
    upper_[k] = high;
  }
}

void ControlLimits::check(const Controls& p) const {
  for (Index k = 0; k < lower_.size(); ++k) {
    const Index row = rows()[at(k)];
    const double lower = scalars_.limits.lower[k], upper = scalars_.limits.upper[k];
    if (!(p(row, 0) >= lower && p(row, 0) <= upper)) refuse(row, p(row, 0), lower, upper);
    if (p(row, 1) != 0 || p(row, 2) != 0)
      throw InputError("control " + std::to_string(row) + " is a scalar: its second and third number must be 0");
  }
}

bool ControlLimits::contain(const Controls& p) const {
  for (Index k = 0; k < lower_.size(); ++k) {
    const Eigen::RowVector3d value = p.row(rows()[at(k)]);
    if (value[0] < scalars_.limits.lower[k] || value[0] > scalars_.limits.upper[k]) return false;
    if (value[1] != 0 || value[2] != 0) return false;
  }
  return true;
}

Controls ControlLimits::nearest(Controls p) const {
  for (Index k = 0; k < lower_.size(); ++k) {
    const Index row = rows()[at(k)];
    p.row(row) << std::clamp(p(row, 0), lower_[k], upper_[k]), 0, 0;
  }
  return p;
}

Controls ControlLimits::nearest_stored(Controls p) const {
  for (Index k = 0; k < lower_.size(); ++k)
    if (is_stored_[at(k)] != 0) p(rows()[at(k)], 0) = static_cast<double>(static_cast<float>(p(rows()[at(k)], 0)));
  return nearest(std::move(p));
}

double ControlLimits::fraction_of_longest_step(const Controls& from, const Controls& to) const {
  double fraction = 1;
  for (Index k = 0; k < lower_.size(); ++k) {
    const Index row = rows()[at(k)];
    const double change = std::abs(to(row, 0) - from(row, 0)), longest = scalars_.limits.longest_step[k];
    if (change > rounding * longest) fraction = std::min(fraction, longest / change);
  }
  return fraction;
}

std::vector<ControlConstraint> ControlLimits::exceeded(const Controls& p, const ConstraintSet& constraints,
                                                       const Metric& metric, const Controls& metric_at) const {
  std::vector<ControlConstraint> rows_of_limits;
  const auto add = [&](Index k, double sign, double limit) {
    const Index row = rows()[at(k)], name = 2 * k + (sign < 0);
    if (constraints.has_limit(name)) return;
    std::optional<ControlConstraint> constraint =
        limit_constraint(row, Vector3(sign, 0, 0), sign * limit, name, metric, metric_at);
    if (constraint) rows_of_limits.push_back(std::move(*constraint));
  };
  for (Index k = 0; k < lower_.size(); ++k) {
    const double value = p(rows()[at(k)], 0);
    if (value < lower_[k]) add(k, 1, lower_[k]);
    if (value > upper_[k]) add(k, -1, upper_[k]);
  }
  return rows_of_limits;
}

}  // namespace stiv
