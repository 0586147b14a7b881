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

/// Points in space, (N, 3), row major, so that they share memory with NumPy arrays.
using Positions = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// A view of positions in memory of Eigen or NumPy with contiguous rows. Other layouts and expressions are copied when
/// the view is made.
using PositionsView = Eigen::Ref<const Positions, 0, Eigen::OuterStride<3>>;
/// Contiguous rows of positions to be written.
using PositionRows = Eigen::Ref<Positions, 0, Eigen::OuterStride<3>>;

/// The controls p of a deformation, (m, 3). The deformation defines the meaning of a row: a cage vertex, a lattice
/// point, or for a rigid motion two rows, center and rotation vector.
using Controls = Positions;

/// A view of controls, or of consecutive rows of them.
using ControlsView = Eigen::Ref<const Controls>;

/// Corner indices of triangles, (F, 3).
using Triangles = Eigen::Matrix<Index, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// End point indices of edges, (E, 2).
using Edges = Eigen::Matrix<Index, Eigen::Dynamic, 2, Eigen::RowMajor>;

/// A sparse field of 3-vectors: value[k] at row index[k], each row once, ascending. For gradients of volumes, over
/// vertices or controls.
struct SparseField {
  std::vector<Index> index;
  std::vector<Vector3> value;
};

}  // namespace stiv
