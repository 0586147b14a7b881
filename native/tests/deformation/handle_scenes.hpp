// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "deformation/finite_differences.hpp"
#include "stiv/deformation/handles.hpp"

namespace stiv::testing {

/// A bent sheet of side x side vertices, its first row fixed, some handles in the middle and along the last row; beside
/// it a triangle without any handle, and a handle in no triangle.
inline HandleDefinition sheet_with_handles(Index side, bool hard, EdgeWeights weights) {
  HandleDefinition definition;
  const Index sheet = side * side;
  definition.rest = random_positions(sheet + 4, 21) * 0.1;
  for (Index i = 0; i < side; ++i)
    for (Index j = 0; j < side; ++j)
      definition.rest.row(i * side + j) += Eigen::RowVector3d(i, j, 0.3 * std::sin(0.7 * i + 0.4 * j));
  definition.triangles.resize(2 * (side - 1) * (side - 1) + 1, 3);
  Index face = 0;
  for (Index i = 0; i + 1 < side; ++i)
    for (Index j = 0; j + 1 < side; ++j) {
      const Index a = i * side + j, b = a + side, c = b + 1, d = a + 1;
      definition.triangles.row(face++) << a, b, c;
      definition.triangles.row(face++) << a, c, d;
    }
  definition.triangles.row(face) << sheet, sheet + 1, sheet + 2;
  for (Index j = 0; j < side; ++j) definition.fixed.push_back(j);
  for (Index j = 1; j < side; j += 2) definition.handles.push_back(sheet - j);
  definition.handles.push_back(side * (side / 2) + side / 2);
  definition.handles.push_back(sheet + 3);
  if (!hard) definition.pull = Eigen::VectorXd::LinSpaced(static_cast<Index>(definition.handles.size()), 0.2, 3);
  definition.edge_weights = weights;
  return definition;
}

/// The positions of the handles at rest, each moved by up to `amount`.
inline Controls moved_handles(const HandleDefinition& definition, double amount) {
  Controls p = amount * random_positions(static_cast<Index>(definition.handles.size()), 22);
  for (std::size_t k = 0; k < definition.handles.size(); ++k)
    p.row(static_cast<Index>(k)) += definition.rest.row(definition.handles[k]);
  return p;
}

}  // namespace stiv::testing
