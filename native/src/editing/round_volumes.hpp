// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "editing/edit_context.hpp"
#include "stiv/volumes/relative.hpp"

namespace stiv {

/// A step with its events.
struct InterferingStep {
  const Events& events;
  const Positions& start;
  const Positions& end;
  const Eigen::VectorXd& areas;  ///< of vertices, for regions, (N)
};

/// The interference volumes of a round.
struct RoundVolumes {
  std::vector<Stiv> stivs;    ///< none if no event has a normal
  Index patches = 0;          ///< also where each contact is a separate STIV
  bool each_contact = false;  ///< each contact is a separate STIV
};

/// The volumes of a step as the options define them. (mathematics.md, "The loop")
/// @param accumulated number of constraints from earlier rounds
RoundVolumes volumes_of_round(const EditContext& context, const InterferingStep& step, int round,
                              std::size_t accumulated, Execution& execution);

/// The most constraints that are solved for at once.
std::size_t max_constraints(const EditContext& context);

}  // namespace stiv
