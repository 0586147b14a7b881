// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "repair/components.hpp"
#include "stiv/repair/contraction.hpp"

namespace stiv {

/// The state after some contraction steps.
struct Contracted {
  Controls positions;
  Index pairs = 0;  ///< number of intersecting pairs
  Index steps = 0;
};

/// A way to contract a surface until nothing intersects.
struct ContractionStrategy {
  std::string name;  ///< of the body, or "all", "shrunk components", "components", "regions"
  std::function<Contracted(const Controls& start, Execution& execution)> run;
};

/// Controls that may move, (m), the vertices that those move, (N), and the supports of all controls.
struct Movable {
  Marks controls;
  Marks vertices;
  std::vector<std::vector<Index>> supports;
};

/// The movable controls that move a marked vertex.
Marks controls_of(const Marks& vertices, const Movable& movable);

/// All strategies, the most promising first.
std::vector<ContractionStrategy> contraction_strategies(const CagedSurface& caged, const StaticPairs& pairs,
                                                        const Movable& movable, const ContractionOptions& options);

}  // namespace stiv
