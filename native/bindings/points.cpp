// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/points.hpp"

#include <pybind11/eigen.h>
#include <pybind11/numpy.h>

#include <vector>

#include "module.hpp"
#include "stiv/error.hpp"

namespace py = pybind11;

namespace stiv::bindings {

namespace {

template <class Scalar>
using Array = py::array_t<Scalar, py::array::c_style | py::array::forcecast>;

/// An array of points, (n, 3), in place.
template <class Scalar>
auto view_of(const Array<Scalar>& points) {
  if (points.ndim() != 2 || points.shape(1) != 3) throw InputError("points must have shape (n, 3)");
  using Rows = Eigen::Matrix<Scalar, Eigen::Dynamic, 3, Eigen::RowMajor>;
  return Eigen::Map<const Rows>(points.data(), points.shape(0), 3);
}

template <class Scalar>
Positions transformed(const AffineMap& map, const Array<Scalar>& points) {
  return transform_points(map, view_of(points));
}

double difference_of(const Array<double>& first, const Array<double>& second) {
  return largest_difference(view_of(first), view_of(second));
}

py::array_t<Index> folded_quads(const Array<float>& points, const Array<Index>& corners, float cosine, float narrow) {
  if (corners.ndim() != 2 || corners.shape(0) != 4) throw InputError("corners must have shape (4, k)");
  const Eigen::Map<const QuadCorners> quads(corners.data(), 4, corners.shape(1));
  const std::vector<Index> folded = find_folded(view_of(points), quads, cosine, narrow);
  return py::array_t<Index>(static_cast<py::ssize_t>(folded.size()), folded.data());
}

}  // namespace

void bind_points(py::module_& module) {
  const py::arg map("map"), points("points"), corners("corners");
  module.def("transform_points", &transformed<double>, map, points);
  module.def("transform_single_points", &transformed<float>, map, points);
  module.def("largest_difference", &difference_of, py::arg("first"), py::arg("second"));
  module.def("find_folded", &folded_quads, points, corners, py::arg("cosine"), py::arg("narrow"));
}

}  // namespace stiv::bindings
