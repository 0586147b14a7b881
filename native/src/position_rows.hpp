// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>

#include "stiv/types.hpp"

namespace stiv {

/// Rows of positions, (k, 3).
inline Positions rows_of(const PositionsView& q, std::span<const Index> rows) {
  Positions some(static_cast<Index>(rows.size()), 3);
  for (std::size_t k = 0; k < rows.size(); ++k) some.row(static_cast<Index>(k)) = q.row(rows[k]);
  return some;
}

/// Replaces these rows with `some`, (k, 3).
inline void put_rows(Positions& q, std::span<const Index> rows, const PositionsView& some) {
  for (std::size_t k = 0; k < rows.size(); ++k) q.row(rows[k]) = some.row(static_cast<Index>(k));
}

}  // namespace stiv
