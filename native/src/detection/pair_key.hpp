// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "stiv/types.hpp"

namespace stiv {

/// Two indices, which are not negative, as one number that sorts as the pair does.
inline std::uint64_t pair_key(Index first, Index second) {
  return static_cast<std::uint64_t>(first) << 32 | static_cast<std::uint64_t>(second);
}

}  // namespace stiv
