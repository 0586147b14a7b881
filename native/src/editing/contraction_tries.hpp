// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "editing/parts.hpp"
#include "stiv/editing/contraction.hpp"

namespace stiv {

/// What a try to contract a surface until nothing intersects came to.
struct Contracted {
  Positions positions;
  Index pairs = 0;  ///< that intersect there
  Index steps = 0;
};

/// One way to contract, from positions at which something intersects.
struct ContractionTry {
  std::string what;  ///< name of the body, "all", "components", "regions"
  std::function<Contracted(const Positions& start, Execution& execution)> run;
};

/// The ways to contract in the order in which they are worth trying. `movable` marks the vertices that may move.
std::vector<ContractionTry> contraction_tries(const std::shared_ptr<const Surface>& surface, const StaticPairs& pairs,
                                              const Marks& movable, const ContractionOptions& options);

}  // namespace stiv
