// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <utility>

#include "stiv/response/resolver.hpp"

namespace stiv {

/// The constraints that held the last solution of a drag back. As its goal moves a little further, most of them hold
/// the next solution back as well, which need not find them again, round by round. Where a contact has ended, its
/// constraint would still act: so each solution begins without a part of them, and none is older than a few solutions.
/// (mathematics.md, "Deep goals")
class ContactMemory {
 public:
  /// Constraints to begin with. None if they are so few that a few rounds find them again, at less energy.
  ConstraintSet take() {
    ConstraintSet taken = std::exchange(constraints_, {});
    if (taken.size() < least_count) return {};
    taken.drop_part(parts, part_);
    part_ = (part_ + 1) % parts;
    return taken;
  }

  /// Keeps those that are active.
  void keep(ConstraintSet constraints) {
    constraints_ = std::move(constraints);
    constraints_.drop_inactive();
  }

 private:
  static constexpr std::size_t least_count = 48;
  static constexpr Index parts = 4;

  ConstraintSet constraints_;
  Index part_ = 0;  ///< the next one to leave out
};

}  // namespace stiv
