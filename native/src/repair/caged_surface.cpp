// SPDX-License-Identifier: GPL-3.0-or-later
#include "repair/caged_surface.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "stiv/deformation/linear.hpp"
#include "stiv/error.hpp"

namespace stiv {

CagedSurface without_cage(const std::shared_ptr<const Surface>& surface) {
  auto identity = make_identity(surface->vertex_count());
  return {surface, std::move(identity), surface};
}

Marks controls_moving(const Marks& vertices, const std::vector<std::vector<Index>>& supports) {
  Marks controls(supports.size());
  for (std::size_t control = 0; control < supports.size(); ++control)
    controls[control] = std::any_of(supports[control].begin(), supports[control].end(),
                                    [&](Index vertex) { return vertices[at(vertex)] != 0; });
  return controls;
}

Marks vertices_moved(const Marks& controls, const std::vector<std::vector<Index>>& supports, Index vertex_count) {
  Marks vertices(static_cast<std::size_t>(vertex_count), 0);
  for (std::size_t control = 0; control < supports.size(); ++control)
    if (controls[control] != 0)
      for (const Index vertex : supports[control]) vertices[at(vertex)] = 1;
  return vertices;
}

std::vector<std::vector<Index>> supports_of(const Deformation& deformation) {
  std::vector<std::vector<Index>> supports;
  for (Index control = 0; control < deformation.control_count(); ++control)
    supports.push_back(deformation.support(control));
  return supports;
}

void check_caged(const CagedSurface& caged, const Controls& p) {
  const auto require = [](Index found, Index wanted, const std::string& what) {
    if (found != wanted)
      throw InputError(what + ": " + std::to_string(found) + " given, expected " + std::to_string(wanted));
  };
  require(caged.deformation->vertex_count(), caged.surface->vertex_count(), "vertices of the deformation");
  require(caged.cage->vertex_count(), caged.deformation->control_count(), "vertices of the cage");
  caged.cage->check_positions(p);
}

}  // namespace stiv
