// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "deformation/linear/weight_rows.hpp"
#include "deformation/subdivision/surface_locations.hpp"
#include "deformation/subdivision/wires.hpp"

namespace stiv {

/// Weights of a cage's vertices in points of its subdivision surface, through OpenSubdiv with the settings of
/// Blender's modifier; for Loop's scheme, which the modifier does not have, with the same ones.
class LimitStencils {
 public:
  /// @throws InputError when OpenSubdiv refuses the cage.
  LimitStencils(const Cage& cage, const CageEdges& edges, const Wires& wires, const SubdivisionOptions& options);
  ~LimitStencils();

  /// Adds the weights of the point at `location`, which must be on a face, to the row being built.
  void add_point(const SurfaceLocation& location, WeightRows& rows) const;

 private:
  struct Tables;
  std::unique_ptr<const Tables> tables_;
};

}  // namespace stiv
