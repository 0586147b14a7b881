// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "stiv/types.hpp"

namespace stiv {

/// Invalid input. The message names the object and the element, and says what to do. Nothing was changed.
class InputError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// The start of an edit has intersections. Repair them, or exclude the pairs.
class StartIntersectsError : public InputError {
 public:
  StartIntersectsError(const std::string& message, std::vector<std::pair<Index, Index>> triangle_pairs)
      : InputError(message), pairs(std::move(triangle_pairs)) {}

  /// All pairs of triangles that intersect.
  std::vector<std::pair<Index, Index>> pairs;
};

/// A deformation has no surface at some controls. Sessions cut the step there.
class InfeasibleError : public InputError {
 public:
  using InputError::InputError;
};

/// The work was cancelled, or its time budget ended. Sessions catch it and return the last accepted state.
class Interrupted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace stiv
