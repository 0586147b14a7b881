// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/deformation/deformation.hpp"

#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "module.hpp"
#include "stiv/deformation/combination.hpp"
#include "stiv/deformation/handles.hpp"
#include "stiv/deformation/lattice.hpp"
#include "stiv/deformation/observed.hpp"
#include "stiv/deformation/placement.hpp"
#include "stiv/deformation/scalars.hpp"
#include "stiv/deformation/subdivision.hpp"
#include "stiv/error.hpp"

namespace py = pybind11;

namespace stiv::bindings {

namespace {

/// Python has no const, but the objects that it holds have no methods that change them.
std::shared_ptr<Deformation> shared(const std::shared_ptr<const Deformation>& deformation) {
  return std::const_pointer_cast<Deformation>(deformation);
}

template <class T>
py::array_t<T> array_of(const T* data, Eigen::Index count) {
  return py::array_t<T>(count, data);
}

template <class T>
using Array = py::array_t<T, py::array::c_style | py::array::forcecast>;

template <class T>
std::vector<T> vector_of(const Array<T>& array) {
  return std::vector<T>(array.data(), array.data() + array.size());
}

/// (starts, controls, values, (n, m)): compressed rows.
py::tuple rows_of(const WeightMatrix& matrix) {
  return py::make_tuple(array_of(matrix.outerIndexPtr(), matrix.rows() + 1),
                        array_of(matrix.innerIndexPtr(), matrix.nonZeros()),
                        array_of(matrix.valuePtr(), matrix.nonZeros()), py::make_tuple(matrix.rows(), matrix.cols()));
}

SparseField nonzero_rows(const Positions& values) {
  SparseField field;
  for (Index row = 0; row < values.rows(); ++row) {
    if (values.row(row).isZero(0)) continue;
    field.index.push_back(row);
    field.value.push_back(values.row(row));
  }
  return field;
}

Positions dense(const SparseField& field, Index count) {
  Positions values = Positions::Zero(count, 3);
  for (std::size_t k = 0; k < field.index.size(); ++k) values.row(field.index[k]) = field.value[k];
  return values;
}

void check_rows(const Positions& values, Index count, const char* name) {
  if (values.rows() != count)
    throw InputError(std::string(name) + " has " + std::to_string(values.rows()) + " rows, expected " +
                     std::to_string(count));
}

Positions pull_back(const Deformation& deformation, const Controls& p, const Positions& g) {
  check_rows(p, deformation.control_count(), "controls");
  check_rows(g, deformation.vertex_count(), "covector");
  return dense(deformation.pull_back(p, nonzero_rows(g)), deformation.control_count());
}

Positions push_forward(const Deformation& deformation, const Controls& p, const Controls& d) {
  check_rows(p, deformation.control_count(), "controls");
  return deformation.push_forward(p, d);
}

using WeightArray = py::array_t<double, py::array::c_style | py::array::forcecast>;

Eigen::VectorXd flat(const WeightArray& weights) {
  return Eigen::Map<const Eigen::VectorXd>(weights.data(), static_cast<Index>(weights.size()));
}

Positions apply_inverse_metric(const Deformation& deformation, const Controls& p, const Positions& g, double smoothness,
                               const WeightArray& weights, const std::vector<Eigen::Matrix3d>& weight_axes) {
  check_rows(p, deformation.control_count(), "controls");
  check_rows(g, deformation.control_count(), "covector");
  const auto metric = deformation.metric({smoothness, flat(weights), weight_axes});
  return dense(metric->apply_inverse(p, nonzero_rows(g)), deformation.control_count());
}

std::vector<Index> support(const Deformation& deformation, Index control) {
  if (control < 0 || control >= deformation.control_count())
    throw InputError("control " + std::to_string(control) + " does not exist; there are " +
                     std::to_string(deformation.control_count()));
  return deformation.support(control);
}

/// Weights and offset of a linear deformation; None for others.
py::object linear_parts(const std::shared_ptr<Deformation>& deformation) {
  const auto* linear = dynamic_cast<const LinearDeformation*>(deformation.get());
  if (linear == nullptr) return py::none();
  return py::make_tuple(rows_of(linear->weights()), linear->offset());
}

/// Weights of shape (k,), or blocks of shape (k, 3, 3).
Jacobian jacobian_of(const Array<Index>& starts, const Array<Index>& controls, const Array<double>& values,
                     Index control_count) {
  using Block = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  if (values.ndim() == 1)
    return {weights_from_rows(vector_of(starts), vector_of(controls), vector_of(values), control_count), {}};
  std::vector<Eigen::Matrix3d> blocks;
  for (py::ssize_t k = 0; k < values.shape(0); ++k) blocks.emplace_back(Eigen::Map<const Block>(values.data() + 9 * k));
  return jacobian_from_blocks(vector_of(starts), vector_of(controls), blocks, control_count);
}

/// A function of Python, which any thread may release.
using SharedFunction = std::shared_ptr<py::object>;

SharedFunction share(py::object function) {
  return SharedFunction(new py::object(std::move(function)), [](py::object* released) {
    const py::gil_scoped_acquire locked;
    delete released;
  });
}

std::shared_ptr<ObservedDeformation> observe(py::object evaluate, Jacobian jacobian, std::vector<Index> rotation_rows) {
  return make_observed(
      [function = share(std::move(evaluate))](const Controls& p) -> std::optional<Positions> {
        const py::gil_scoped_acquire locked;
        const py::object value = (*function)(p);
        if (value.is_none()) return std::nullopt;
        return value.cast<Positions>();
      },
      std::move(jacobian), std::move(rotation_rows));
}

void bind_observed(py::module_& module) {
  const py::arg starts("starts"), controls("controls"), values("values"), control_count("control_count");
  py::class_<ObservedDeformation, Deformation, std::shared_ptr<ObservedDeformation>>(module, "ObservedDeformation")
      .def(py::init([](py::object evaluate, const Array<Index>& rows, const Array<Index>& columns,
                       const Array<double>& entries, Index count, std::vector<Index> rotation_rows) {
             return observe(std::move(evaluate), jacobian_of(rows, columns, entries, count), std::move(rotation_rows));
           }),
           py::arg("evaluate"), starts, controls, values, control_count, py::arg("rotation_rows"))
      .def(
          "replace_jacobian",
          [](ObservedDeformation& deformation, const Array<Index>& rows, const Array<Index>& columns,
             const Array<double>& entries,
             Index count) { deformation.set_jacobian(jacobian_of(rows, columns, entries, count)); },
          starts, controls, values, control_count)
      .def_property_readonly("jacobian_revision", &ObservedDeformation::revision,
                             "How often the Jacobian was replaced.");
}

/// The same for scalars.
std::shared_ptr<ScalarDeformation> observe_scalars(py::object evaluate, ScalarJacobian jacobian, Eigen::VectorXd lower,
                                                   Eigen::VectorXd upper, Eigen::VectorXd longest_step) {
  return make_scalars(
      [function = share(std::move(evaluate))](const Eigen::VectorXd& values) -> std::optional<Positions> {
        const py::gil_scoped_acquire locked;
        const py::object value = (*function)(values);
        if (value.is_none()) return std::nullopt;
        return value.cast<Positions>();
      },
      std::move(jacobian), {std::move(lower), std::move(upper), std::move(longest_step)});
}

void bind_scalars(py::module_& module) {
  py::class_<ScalarDeformation, Deformation, std::shared_ptr<ScalarDeformation>>(module, "ScalarDeformation")
      .def(py::init(&observe_scalars), py::arg("evaluate"), py::arg("jacobian"), py::arg("lower"), py::arg("upper"),
           py::arg("longest_step"))
      .def("replace_jacobian", &ScalarDeformation::set_jacobian, py::arg("jacobian"))
      .def_property_readonly("jacobian_revision", &ScalarDeformation::revision, "How often the Jacobian was replaced.");
}

LatticeInterpolation interpolation_of(const std::string& name) {
  if (name == "linear") return LatticeInterpolation::linear;
  if (name == "cardinal") return LatticeInterpolation::cardinal;
  if (name == "catmull_rom") return LatticeInterpolation::catmull_rom;
  if (name == "bspline") return LatticeInterpolation::bspline;
  throw InputError("interpolation \"" + name + "\" is unknown; choose linear, cardinal, catmull_rom or bspline");
}

BoundarySmoothing boundary_of(const std::string& name) {
  if (name == "all") return BoundarySmoothing::all;
  if (name == "preserve_corners") return BoundarySmoothing::preserve_corners;
  throw InputError("boundary \"" + name + "\" is unknown; choose all or preserve_corners");
}

SubdivisionScheme scheme_of(const std::string& name) {
  if (name == "catmull_clark") return SubdivisionScheme::catmull_clark;
  if (name == "loop") return SubdivisionScheme::loop;
  throw InputError("scheme \"" + name + "\" is unknown; choose catmull_clark or loop");
}

Cage make_cage(Index vertex_count, const Edges& edges, std::vector<Index> corners, std::vector<Index> starts,
               std::vector<float> edge_crease, std::vector<float> vertex_crease) {
  return {vertex_count, edges, std::move(corners), std::move(starts), std::move(edge_crease), std::move(vertex_crease)};
}

EdgeWeights edge_weights_of(const std::string& name) {
  if (name == "uniform") return EdgeWeights::uniform;
  if (name == "cotangent") return EdgeWeights::cotangent;
  throw InputError("edge weights \"" + name + "\" are unknown; choose uniform or cotangent");
}

HandleDefinition make_handles(Positions rest, Triangles triangles, std::vector<Index> handles, Eigen::VectorXd pull,
                              std::vector<Index> fixed, const std::string& edge_weights) {
  return {std::move(rest), std::move(triangles), std::move(handles),
          std::move(pull), std::move(fixed),     edge_weights_of(edge_weights)};
}

std::shared_ptr<Deformation> compose(const std::shared_ptr<Deformation>& outer,
                                     const std::shared_ptr<Deformation>& inner) {
  const auto linear = std::dynamic_pointer_cast<const LinearDeformation>(outer);
  const auto observed = std::dynamic_pointer_cast<const SparseJacobianDeformation>(outer);
  const auto inner_linear = std::dynamic_pointer_cast<const LinearDeformation>(inner);
  const auto inner_other = std::dynamic_pointer_cast<const ComposableDeformation>(inner);
  if (linear && inner_linear) return shared(make_composition(*linear, *inner_linear));
  if (linear && inner_other) return shared(make_composition(linear, inner_other));
  if (observed && inner_linear) return shared(make_composition(observed, inner_linear));
  if (observed && inner_other) return shared(make_composition(observed, inner_other));
  throw InputError(
      "compose: the outer deformation must be linear or observed, the inner one linear, observed, by scalars or by "
      "handles; compose chains from the inside, and concatenate others side by side");
}

std::shared_ptr<Deformation> concatenate(
    const std::vector<std::pair<std::shared_ptr<Deformation>, Array<Index>>>& parts, Positions start) {
  std::vector<DeformationComponent> native;
  native.reserve(parts.size());
  for (const auto& [deformation, vertices] : parts) native.push_back({deformation, vector_of(vertices)});
  return shared(make_concatenation(std::move(native), std::move(start)));
}

LatticeDefinition make_lattice_definition(const std::array<Index, 3>& resolution,
                                          const std::array<std::string, 3>& interpolation, Positions rest,
                                          Eigen::VectorXd point_weights) {
  LatticeDefinition lattice{resolution, {}, std::move(rest), std::move(point_weights)};
  for (std::size_t axis = 0; axis < 3; ++axis) lattice.interpolation[axis] = interpolation_of(interpolation[axis]);
  return lattice;
}

void bind_class(py::module_& module) {
  py::class_<Deformation, std::shared_ptr<Deformation>>(
      module, "Deformation",
      "Map q = f(p) from controls p, (m, 3), to world positions q of a surface, (n, 3).\n\n"
      "Made by the functions of this package: identity, linear, rigid, ... Immutable and safe to use from any thread.")
      .def_property_readonly("control_count", &Deformation::control_count, "m, the number of rows of the controls.")
      .def_property_readonly("vertex_count", &Deformation::vertex_count, "n, the number of vertices of the surface.")
      .def_property_readonly("rotation_rows", &Deformation::rotation_rows,
                             "Rows of the controls that are rotation vectors (radians) instead of points.")
      .def("surface", py::overload_cast<const Controls&>(&Deformation::surface, py::const_), py::arg("controls"),
           py::call_guard<py::gil_scoped_release>(), "Return the positions f(p), (n, 3), at controls p, (m, 3).")
      .def("pull_back", &pull_back, py::arg("controls"), py::arg("covector"), py::call_guard<py::gil_scoped_release>(),
           "Return J(p)^T g, (m, 3), for a covector g over the vertices, (n, 3).")
      .def("push_forward", &push_forward, py::arg("controls"), py::arg("motion"),
           py::call_guard<py::gil_scoped_release>(),
           "Return J(p) d, (n, 3), the velocity of the surface for a motion d of the controls, (m, 3).")
      .def("apply_inverse_metric", &apply_inverse_metric, py::arg("controls"), py::arg("covector"),
           py::arg("smoothness") = 0.1, py::arg("weights") = WeightArray(0),
           py::arg("weight_axes") = std::vector<Eigen::Matrix3d>(), py::call_guard<py::gil_scoped_release>(),
           "Return W^1/2 (J^T J + damping)^-1 W^1/2 g, (m, 3), for a covector g over the controls, (m, 3).\n\n"
           "smoothness   > 0, the damping relative to the diagonal\n"
           "weights      (m,) or (m, 3), default 1; 0 pins a control or one of its coordinates\n"
           "weight_axes  (m, 3, 3): the three weights of a control act along the columns of a rotation")
      .def("support", &support, py::arg("control"), "Return the vertices that a control moves, in ascending order.");
}

}  // namespace

void bind_deformation(py::module_& module) {
  bind_class(module);
  bind_observed(module);
  bind_scalars(module);
  module.def(
      "identity", [](Index count) { return shared(make_identity(count)); }, py::arg("vertex_count"));
  module.def(
      "linear",
      [](const Array<Index>& starts, const Array<Index>& controls, const Array<double>& values, Index control_count,
         Positions offset) {
        return shared(
            make_linear(weights_from_rows(vector_of(starts), vector_of(controls), vector_of(values), control_count),
                        std::move(offset)));
      },
      py::arg("starts"), py::arg("controls"), py::arg("values"), py::arg("control_count"), py::arg("offset"));
  module.def("linear_parts", &linear_parts, py::arg("deformation"));
  module.def(
      "rigid",
      [](const Positions& rest, const std::optional<Vector3>& pivot) { return shared(make_rigid(rest, pivot)); },
      py::arg("rest"), py::arg("pivot") = py::none());
  module.def("rigid_rest_controls", &rigid_rest_controls, py::arg("rest"));
  module.def(
      "scaling",
      [](const Positions& rest, const Eigen::Matrix3d& rotation) { return shared(make_scaling(rest, rotation)); },
      py::arg("rest"), py::arg("rotation"));
  module.def("scaling_rest_controls", &scaling_rest_controls, py::arg("rest"));
  module.def("concatenate", &concatenate, py::arg("parts"), py::arg("start"));
  module.def("compose", &compose, py::arg("outer"), py::arg("inner"));
  py::class_<HandleDefinition>(module, "Handles")
      .def(py::init(&make_handles), py::arg("rest"), py::arg("triangles"), py::arg("handles"), py::arg("pull"),
           py::arg("fixed"), py::arg("edge_weights"));
  module.def(
      "laplacian", [](const HandleDefinition& handles) { return shared(make_laplacian(handles)); }, py::arg("handles"),
      py::call_guard<py::gil_scoped_release>());
  module.def(
      "arap", [](const HandleDefinition& handles) { return shared(make_arap(handles)); }, py::arg("handles"),
      py::call_guard<py::gil_scoped_release>());
  py::class_<Cage>(module, "Cage")
      .def(py::init(&make_cage), py::arg("vertex_count"), py::arg("edges"), py::arg("corners"), py::arg("starts"),
           py::arg("edge_crease"), py::arg("vertex_crease"));
  module.def(
      "subdivision_weights",
      [](const Cage& cage, int levels, bool limit_surface, int quality, bool simple, const std::string& boundary,
         const std::string& scheme) {
        return rows_of(subdivision_weights(
            cage, {levels, limit_surface, quality, simple, boundary_of(boundary), scheme_of(scheme)}));
      },
      py::arg("cage"), py::arg("levels"), py::arg("limit_surface"), py::arg("quality"), py::arg("simple"),
      py::arg("boundary"), py::arg("scheme"));
  module.def("subdivided_faces", &subdivided_faces, py::arg("cage"), py::arg("levels"));
  module.def("subdivided_triangles", &subdivided_triangles, py::arg("cage"), py::arg("levels"));
  py::class_<LatticeDefinition>(module, "Lattice")
      .def(py::init(&make_lattice_definition), py::arg("resolution"), py::arg("interpolation"), py::arg("rest"),
           py::arg("point_weights"));
  module.def(
      "lattice_weights",
      [](const LatticeDefinition& lattice, const Positions& vertices, const Eigen::VectorXd& influence) {
        return rows_of(lattice_weights(lattice, vertices, influence));
      },
      py::arg("lattice"), py::arg("vertices"), py::arg("influence"));
  module.def(
      "lattice",
      [](const LatticeDefinition& lattice, Positions rest_vertices, Eigen::VectorXd influence, Positions vertices,
         Controls points) {
        return shared(make_lattice(
            lattice, {std::move(rest_vertices), std::move(influence), std::move(vertices), std::move(points)}));
      },
      py::arg("lattice"), py::arg("rest_vertices"), py::arg("influence"), py::arg("vertices"), py::arg("points"));
}

}  // namespace stiv::bindings
