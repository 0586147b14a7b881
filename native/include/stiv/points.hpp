// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stiv/types.hpp"

/// Passes over all points of large meshes, for applications that read and write them between two edits.
namespace stiv {

/// Points in single precision, (N, 3), as applications store them.
using SinglePositions = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;
using SinglePositionsView = Eigen::Ref<const SinglePositions, 0, Eigen::OuterStride<3>>;

/// An affine map: linear part, then translation.
using AffineMap = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;

/// Points mapped in double precision, (N, 3). Each coordinate is ((x + z) + y) + translation.
Positions transform_points(const AffineMap& map, const PositionsView& points);
Positions transform_points(const AffineMap& map, const SinglePositionsView& points);

/// The largest difference between two coordinates at the same place; NaN if one of them is.
/// @throws InputError if the numbers of points differ
double largest_difference(const PositionsView& first, const PositionsView& second);

/// Corners of quads, (4, K), in the order of the face. The first diagonal connects the first corner and the third.
using QuadCorners = Eigen::Matrix<Index, 4, Eigen::Dynamic, Eigen::RowMajor>;

/// The quads, ascending, that are not certainly open along the first diagonal: the cosine of the angle between the
/// normals of their halves may be `cosine` or less, or a half rises above the diagonal by at most `narrow` times the
/// largest coordinate. In single precision, as applications decide.
/// @throws InputError if a corner is not a point
std::vector<Index> find_folded(const SinglePositionsView& points, const Eigen::Ref<const QuadCorners>& corners,
                               float cosine, float narrow);

}  // namespace stiv
