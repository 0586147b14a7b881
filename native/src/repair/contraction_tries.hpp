// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "repair/components.hpp"
#include "stiv/repair/contraction.hpp"

namespace stiv {

/// What a try to contract a surface until nothing intersects came to.
struct Contracted {
  Controls positions;
  Index pairs = 0;  ///< that intersect there
  Index steps = 0;
};

/// One way to contract, from positions at which something intersects.
struct ContractionTry {
  std::string what;  ///< name of the body, "all", "shrunk components", "components", "regions"
  std::function<Contracted(const Controls& start, Execution& execution)> run;
};

/// What may move: `controls` (m), and the vertices that those move, (N); `supports` of all controls.
struct Movable {
  Marks controls;
  Marks vertices;
  std::vector<std::vector<Index>> supports;
};

/// Which controls move the vertices of a part, among those that may move.
Marks controls_of(const Marks& part, const Movable& movable);

/// The ways to contract in the order in which they are worth trying.
std::vector<ContractionTry> contraction_tries(const CagedSurface& caged, const StaticPairs& pairs,
                                              const Movable& movable, const ContractionOptions& options);

}  // namespace stiv
