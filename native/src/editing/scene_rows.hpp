// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <utility>

#include "stiv/detection/event.hpp"
#include "stiv/types.hpp"

namespace stiv {

/// Positions of a surface, followed by rows that never change: those of obstacles. Only the rows of the surface are
/// copied from call to call.
class SceneRows {
 public:
  /// @param rest the rows after the surface's, (k, 3), which must outlive this
  explicit SceneRows(const Positions& rest) : rest_(rest) {}

  /// All rows, until the next call; those given if no others follow.
  const Positions& with_rest(const Positions& q) { return rest_.rows() == 0 ? q : copied(q); }
  PositionsView with_rest(const PositionsView& q) { return rest_.rows() == 0 ? q : PositionsView(copied(q)); }

  /// The same, but only the rows of vertices of events; the others are undefined.
  const Positions& with_rest_at(const Events& events, const Positions& q) {
    const auto count = static_cast<Index>(q.rows()), all = static_cast<Index>(count + rest_.rows());
    if (rest_.rows() == 0 || 4 * events.size() > at(has_rest_ ? count : all)) return with_rest(q);  // it is faster
    if (rows_.rows() != all) resize(all);
    for (const Event& event : events)
      for (const Index vertex : event.vertices)
        rows_.row(vertex) = vertex < count ? q.row(vertex) : rest_.row(vertex - count);
    return rows_;
  }

  /// All rows, of which the first `count` are to be written.
  Positions& with_room_for(Index count) {
    if (rows_.rows() != count + rest_.rows()) resize(static_cast<Index>(count + rest_.rows()));
    if (!std::exchange(has_rest_, true)) rows_.bottomRows(rest_.rows()) = rest_;
    return rows_;
  }

 private:
  const Positions& copied(const PositionsView& q) {
    Positions& rows = with_room_for(static_cast<Index>(q.rows()));
    rows.topRows(q.rows()) = q;
    return rows;
  }

  void resize(Index count) {
    rows_.resize(count, 3);
    has_rest_ = false;
  }

  const Positions& rest_;
  Positions rows_;
  bool has_rest_ = false;  ///< `rows_` ends with all rows of `rest_`
};

}  // namespace stiv
