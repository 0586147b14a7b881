// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "stiv/types.hpp"

namespace stiv {

/// Input that cannot be worked with. The message names the object, the element and the way out; nothing was changed.
class InputError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// The start of an edit already contains intersections. Ways out: repair, or exclude the pairs of bodies.
class StartIntersectsError : public InputError {
 public:
  StartIntersectsError(const std::string& message, std::vector<std::pair<Index, Index>> triangle_pairs)
      : InputError(message), pairs(std::move(triangle_pairs)) {}

  /// Pairs of triangle indices that meet; all of them.
  std::vector<std::pair<Index, Index>> pairs;
};

/// Thrown through the core when the user cancelled or the time budget ended; caught by the session, which returns the
/// last accepted state.
class Interrupted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace stiv
