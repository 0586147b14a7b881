// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "deformation/linear/weight_rows.hpp"
#include "deformation/subdivision/subdivided_vertices.hpp"
#include "deformation/subdivision/wires.hpp"

namespace stiv {

/// Weights of a cage's vertices for points of its subdivision surface, by OpenSubdiv with the settings of Blender's
/// modifier. Loop's scheme, which the modifier lacks, uses the same settings.
class LimitStencils {
 public:
  /// @throws InputError if OpenSubdiv rejects the cage
  LimitStencils(const Cage& cage, const CageEdges& edges, const Wires& wires, const SubdivisionOptions& options);
  ~LimitStencils();

  /// Adds the weights of the point at `location`, which must be on a face, to the row being built.
  void add_point(const SurfaceLocation& location, WeightRows& rows) const;

 private:
  struct Tables;
  std::unique_ptr<const Tables> tables_;
};

}  // namespace stiv
