// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace stiv {

/// Index of a vertex, edge, triangle, control or body.
using Index = std::int32_t;

/// An index as a subscript of standard containers.
constexpr std::size_t at(std::ptrdiff_t index) { return static_cast<std::size_t>(index); }

using Vector3 = Eigen::Vector3d;

/// Points in space, one a row: (N, 3), row major, so that they share memory with NumPy arrays.
using Positions = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// Positions looked at where they are, in memory of Eigen or of NumPy: rows follow each other without a gap. What lies
/// otherwise, or is still to be computed, is copied when the view is made.
using PositionsView = Eigen::Ref<const Positions, 0, Eigen::OuterStride<3>>;

/// The controls `p` of a deformation, (m, 3). What a row means is the deformation's affair: a cage vertex, a
/// lattice point, or for a rigid placement two rows, centre and rotation vector.
using Controls = Positions;

/// Controls, or some rows that follow each other out of more of them, looked at where they are.
using ControlsView = Eigen::Ref<const Controls>;

/// Corner indices of triangles, (F, 3).
using Triangles = Eigen::Matrix<Index, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// End point indices of edges, (E, 2).
using Edges = Eigen::Matrix<Index, Eigen::Dynamic, 2, Eigen::RowMajor>;

/// A field of 3-vectors that is zero nearly everywhere: `value[k]` stands at row `index[k]`, each row once, ascending.
/// Gradients of volumes, over surface vertices or over controls.
struct SparseField {
  std::vector<Index> index;
  std::vector<Vector3> value;
};

}  // namespace stiv
