// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/detection/manageable_part.hpp"

#include <utility>

namespace stiv {

EventsUntil find_manageable_part(Detector& detector, const Positions& start, const Positions& end, Proximity proximity,
                                 Execution& execution) {
  constexpr double least = 0x1p-16;
  std::optional<Events> events = detector.find_if_manageable(start, end, proximity, execution);
  if (events) return {std::move(*events), 1};
  double until = 1;
  while (!events) {
    until /= 2;
    const Positions part = start + until * (end - start);
    if (until > least)
      events = detector.find_if_manageable(start, part, proximity, execution);
    else
      events = detector.find(start, part, proximity, execution);
  }
  for (Event& event : *events) event.time *= until;
  return {std::move(*events), until};
}

}  // namespace stiv
