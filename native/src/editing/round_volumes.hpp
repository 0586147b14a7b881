// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "editing/edit_context.hpp"
#include "stiv/volumes/stiv.hpp"

namespace stiv {

/// A step with interference.
struct InterferingStep {
  const Events& events;
  const Positions& start;
  const Positions& end;
  const Eigen::VectorXd& areas;  ///< of regions, (N)
};

/// What the response answers.
struct Measurement {
  std::vector<Stiv> stivs;    ///< none if no event tells a way out
  Index patches = 0;          ///< also where each contact is a STIV of its own
  bool each_contact = false;  ///< is it?
};

/// The volumes of a step in a round of a sub-edit, as the options have them.
/// @param kept constraints kept from the rounds before
Measurement measure(const Problem& problem, const InterferingStep& step, int round, std::size_t kept,
                    Execution& execution);

/// So many constraints can be solved for at once.
std::size_t most_constraints(const Problem& problem);

}  // namespace stiv
