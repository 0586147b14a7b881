// SPDX-License-Identifier: GPL-3.0-or-later
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include "conversions.hpp"
#include "module.hpp"
#include "stiv/acceptance/step_check.hpp"
#include "stiv/acceptance/storage.hpp"
#include "stiv/editing/obstacle.hpp"
#include "stiv/error.hpp"

namespace py = pybind11;

namespace stiv::bindings {

namespace {

using SurfacePointer = std::shared_ptr<Surface>;

Edges find_intersections(const SurfacePointer& surface, const PositionsView& q, int threads) {
  Execution execution(threads);
  return as_rows(IntersectionTest(surface).find(q, execution));
}

Eigen::VectorXd depths_of(const SurfacePointer& surface, const IndexPairs& pairs, const PositionsView& q) {
  const std::vector<double> depths = intersection_depths(*surface, pairs, q);
  return Eigen::Map<const Eigen::VectorXd>(depths.data(), static_cast<Eigen::Index>(depths.size()));
}

std::pair<Edges, Edges> find_loose_intersections(const SurfacePointer& surface, const PositionsView& q, double distance,
                                                 int threads) {
  Execution execution(threads);
  const StaticPairs found =
      IntersectionTest(surface, {.lists_near_pairs = true}).find_near_loose(q, distance, execution);
  return {as_rows(found.loose_edges), as_rows(found.loose_vertices)};
}

bool step_is_free(const SurfacePointer& surface, const PositionsView& start, const PositionsView& end,
                  double separation, int threads) {
  Execution execution(threads);
  IntersectionTest test(surface);
  Detector detector(surface);
  return test.is_free(start, {}, execution) && is_step_free(detector, test, start, end, {separation}, execution);
}

/// A static test that keeps its trees between calls.
struct CachedIntersectionTest {
  CachedIntersectionTest(const SurfacePointer& surface, int thread_count) : test(surface), threads(thread_count) {}

  Edges find(const PositionsView& q) {
    Execution execution(threads);
    return as_rows(test.find(q, execution));
  }

  IntersectionTest test;
  int threads;
};

/// A test of steps that keeps its trees between calls.
struct StepCheck {
  StepCheck(const SurfacePointer& surface, int thread_count)
      : detector(surface), intersections(surface), threads(thread_count) {}

  bool is_free(const PositionsView& start, const PositionsView& end, double separation) {
    Execution execution(threads);
    return is_step_free(detector, intersections, start, end, {separation}, execution);
  }

  bool is_end_free(const PositionsView& start, const PositionsView& end) {
    Execution execution(threads);
    return intersections.is_free(end, moved_vertices(start, end, execution), execution);
  }

  Detector detector;
  IntersectionTest intersections;
  int threads;
};

std::shared_ptr<Deformation> stored_mesh(const std::shared_ptr<Deformation>& mesh, const Eigen::Matrix4d& frame) {
  const auto handles = std::dynamic_pointer_cast<const HandleDeformation>(mesh);
  if (handles == nullptr) throw InputError("deformation: only a mesh moved by handles can be stored by its vertices");
  return std::const_pointer_cast<Deformation>(std::shared_ptr<const Deformation>(make_stored_mesh(handles, frame)));
}

}  // namespace

Edges as_rows(const IndexPairs& pairs) {
  Edges rows(static_cast<Index>(pairs.size()), 2);
  for (std::size_t k = 0; k < pairs.size(); ++k) rows.row(static_cast<Index>(k)) << pairs[k].first, pairs[k].second;
  return rows;
}

py::object tuple_of(const std::optional<NearestTriangles>& nearest) {
  if (!nearest) return py::none();
  Positions points(2, 3);
  for (Index k = 0; k < 2; ++k) points.row(k) = nearest->points[at(k)].transpose();
  return py::make_tuple(nearest->distance, nearest->triangles, points);
}

void bind_acceptance(py::module_& module) {
  using Release = py::call_guard<py::gil_scoped_release>;
  const py::arg surface("surface"), positions("positions"), start("start"), end("end"), separation("separation"),
      threads("threads");
  module.def("find_intersections", &find_intersections, surface, positions, threads, Release());
  module.def("find_loose_intersections", &find_loose_intersections, surface, positions, py::arg("distance"), threads,
             Release());
  module.def("intersection_depths", &depths_of, surface, py::arg("pairs"), positions, Release());
  module.def("is_step_free", &step_is_free, surface, start, end, separation, threads, Release());
  module.def("stored_mesh", &stored_mesh, py::arg("mesh"), py::arg("frame"));
  module.def(
      "least_distance",
      [](const SurfacePointer& of, const PositionsView& q, bool within,
         const std::vector<std::shared_ptr<Obstacle>>& beside) {
        return tuple_of([&] {
          const py::gil_scoped_release unlocked;
          const DistancePairs pairs = within ? DistancePairs::all : DistancePairs::between_bodies;
          return least_distance(of, {beside.begin(), beside.end()}, q, pairs, Execution(1));
        }());
      },
      surface, positions, py::arg("within"), py::arg("obstacles"));
  py::class_<CachedIntersectionTest>(module, "IntersectionTest")
      .def(py::init<const SurfacePointer&, int>(), surface, threads)
      .def("find", &CachedIntersectionTest::find, positions, Release());
  py::class_<DeviationTest, std::shared_ptr<DeviationTest>>(module, "DeviationTest")
      .def_property_readonly("reach", &DeviationTest::reach)
      .def(
          "is_free",
          [](const DeviationTest& test, const PositionsView& q, int thread_count) {
            Execution execution(thread_count);
            return test.is_free(q, execution);
          },
          positions, threads, Release());
  py::class_<StepCheck>(module, "StepCheck")
      .def(py::init<const SurfacePointer&, int>(), surface, threads)
      .def("is_free", &StepCheck::is_free, start, end, separation, Release())
      .def("is_end_free", &StepCheck::is_end_free, start, end, Release());
}

}  // namespace stiv::bindings
