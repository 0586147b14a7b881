// SPDX-License-Identifier: GPL-3.0-or-later
#include <pybind11/eigen.h>
#include <pybind11/native_enum.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <atomic>

#include "conversions.hpp"
#include "module.hpp"
#include "stiv/coordinate_range.hpp"
#include "stiv/detection/detector.hpp"
#include "stiv/detection/narrow_phase.hpp"
#include "stiv/error.hpp"

namespace py = pybind11;

namespace stiv::bindings {

namespace {

/// (M, 12): the coordinates of four vertices a row.
using Quadruples = Eigen::Matrix<double, Eigen::Dynamic, 12, Eigen::RowMajor>;

PairMotion motion_at(const Quadruples& start, const Quadruples& end, Index row) {
  PairMotion motion;
  for (std::size_t k = 0; k < 4; ++k) {
    motion.start[k] = start.row(row).segment<3>(3 * static_cast<Index>(k));
    motion.end[k] = end.row(row).segment<3>(3 * static_cast<Index>(k));
  }
  return motion;
}

void check_quadruples(const Quadruples& points, const char* name) {
  for (Index row = 0; row < points.rows(); ++row)
    for (const double coordinate : points.row(row))
      if (const char* fault = coordinate_fault(coordinate))
        throw InputError(std::string(name) + ", row " + std::to_string(row) + ": " + fault);
}

Eigen::VectorXd times_of_impact(EventKind kind, const Quadruples& start, const Quadruples& end, double separation,
                                int threads) {
  check_quadruples(start, "start");
  check_quadruples(end, "end");
  Eigen::VectorXd times(start.rows());
  const Execution execution(threads);
  execution.for_chunks(static_cast<Index>(start.rows()), 256, [&](Index begin, Index last, Index) {
    for (Index row = begin; row < last; ++row)
      times[row] = time_of_impact(kind, motion_at(start, end, row), separation);
  });
  return times;
}

/// A detector that refuses to be used by two threads at once.
class GuardedDetector {
 public:
  GuardedDetector(std::shared_ptr<Surface> surface, BroadPhase broad_phase, NarrowPhase narrow_phase, int threads)
      : detector_(std::move(surface), {broad_phase, narrow_phase}), threads_(threads) {}

  Events find(const PositionsView& start, const PositionsView& end, double separation, double min_clearance_ratio) {
    const Use use(busy_);
    Execution execution(threads_);
    return detector_.find(start, end, {separation, min_clearance_ratio}, execution);
  }

  double earliest_time(const PositionsView& start, const PositionsView& end, double separation,
                       double min_clearance_ratio) {
    const Use use(busy_);
    Execution execution(threads_);
    return detector_.earliest_time(start, end, {separation, min_clearance_ratio}, execution);
  }

 private:
  struct Use {
    explicit Use(std::atomic<bool>& flag) : busy(flag) {
      if (busy.exchange(true)) throw InputError("this Detector is in use by another thread; make one for each");
    }
    ~Use() { busy = false; }
    std::atomic<bool>& busy;
  };

  Detector detector_;
  int threads_;
  std::atomic<bool> busy_{false};
};

py::tuple find_arrays(GuardedDetector& detector, const PositionsView& start, const PositionsView& end,
                      double separation, double min_clearance_ratio) {
  const Events events = [&] {
    const py::gil_scoped_release release;
    return detector.find(start, end, separation, min_clearance_ratio);
  }();
  return arrays_of(events);
}

}  // namespace

py::tuple arrays_of(const Events& events) {
  const auto count = static_cast<py::ssize_t>(events.size());
  py::array_t<std::uint8_t> kind(count);
  py::array_t<Index> vertices({count, py::ssize_t{4}});
  py::array_t<double> time(count), weights({count, py::ssize_t{4}}), normal({count, py::ssize_t{3}}), distance(count);
  for (py::ssize_t row = 0; row < count; ++row) {
    const Event& event = events[at(row)];
    kind.mutable_at(row) = static_cast<std::uint8_t>(event.kind);
    time.mutable_at(row) = event.time;
    distance.mutable_at(row) = event.start_distance;
    std::copy(event.vertices.begin(), event.vertices.end(), vertices.mutable_data(row, 0));
    std::copy(event.weights.begin(), event.weights.end(), weights.mutable_data(row, 0));
    std::copy(event.normal.data(), event.normal.data() + 3, normal.mutable_data(row, 0));
  }
  return py::make_tuple(kind, vertices, time, weights, normal, distance);
}

void bind_detection(py::module_& module) {
  using Release = py::call_guard<py::gil_scoped_release>;
  py::native_enum<EventKind>(module, "EventKind", "enum.Enum")
      .value("vf", EventKind::vertex_face)
      .value("ee", EventKind::edge_edge)
      .finalize();
  py::native_enum<BroadPhase>(module, "BroadPhase", "enum.Enum")
      .value("bvh", BroadPhase::bvh)
      .value("hash_grid", BroadPhase::hash_grid)
      .value("brute_force", BroadPhase::brute_force)
      .finalize();
  py::native_enum<NarrowPhase>(module, "NarrowPhase", "enum.Enum")
      .value("conservative", NarrowPhase::conservative)
      .value("polynomial", NarrowPhase::polynomial)
      .finalize();
  module.def("times_of_impact", &times_of_impact, py::arg("kind"), py::arg("start"), py::arg("end"),
             py::arg("separation"), py::arg("threads"), Release());
  const py::arg start("start"), end("end"), separation("separation"), min_clearance_ratio("min_clearance_ratio");
  py::class_<GuardedDetector>(module, "Detector")
      .def(py::init<std::shared_ptr<Surface>, BroadPhase, NarrowPhase, int>(), py::arg("surface"),
           py::arg("broad_phase"), py::arg("narrow_phase"), py::arg("threads"))
      .def("find", &find_arrays, start, end, separation, min_clearance_ratio)
      .def("earliest_time", &GuardedDetector::earliest_time, start, end, separation, min_clearance_ratio, Release());
}

}  // namespace stiv::bindings
