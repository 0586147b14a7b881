// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/editing/session.hpp"

#include <pybind11/native_enum.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "calls.hpp"
#include "conversions.hpp"
#include "job.hpp"
#include "module.hpp"

namespace stiv::bindings {

namespace {

const char* name_of(EditStatus status) {
  switch (status) {
    case EditStatus::reached:
      return "reached";
    case EditStatus::corrected:
      return "corrected";
    case EditStatus::blocked:
      return "blocked";
    case EditStatus::budget:
      return "budget";
    case EditStatus::cancelled:
      return "cancelled";
    case EditStatus::unchanged:
      return "unchanged";
  }
  return "";
}

}  // namespace

py::dict dict_of(const EditResult& result) {
  py::dict values;
  values["status"] = name_of(result.status);
  values["controls"] = result.controls;
  values["path"] = result.path;
  values["surface"] = result.surface;
  values["energy"] = result.energy;
  values["fraction"] = result.fraction;
  values["events"] = arrays_of(result.events);
  values["patches"] = result.patches;
  values["blocking"] = result.blocking;
  values["counters"] = dict_of(result.counters);
  values["timings"] = dict_of(result.timings);
  return values;
}

namespace {

/// Marks a session as in use for the length of a scope.
class InUse {
 public:
  explicit InUse(std::atomic<bool>& flag) : flag_(flag) {
    if (flag_.exchange(true)) throw InputError("the session is in use by another call; wait for it, or cancel it");
  }
  ~InUse() { flag_ = false; }
  InUse(const InUse&) = delete;
  InUse& operator=(const InUse&) = delete;

 private:
  std::atomic<bool>& flag_;
};

using SurfacePointer = std::shared_ptr<const Surface>;
using DeformationPointer = std::shared_ptr<const Deformation>;
using SessionCall = std::function<EditResult(EditSession&, Execution&)>;

SessionCall edit_to(const DoubleArray& goal) {
  return [to = controls_from(goal, "goal")](EditSession& session, Execution& execution) {
    return session.edit(to, execution);
  };
}

/// Limits of a drag's call, in seconds.
struct DragTimes {
  std::optional<double> time_budget, hand_over;

  void check() const {
    if (time_budget && !(*time_budget > 0 && std::isfinite(*time_budget)))
      throw InputError("time_budget must be a positive number of seconds");
    if (hand_over && !(*hand_over >= 0 && std::isfinite(*hand_over)))
      throw InputError("hand_over must be a number of seconds, 0 or more");
  }
};

SessionCall drag_to(const DoubleArray& goal, const DragTimes& times) {
  times.check();
  return [to = controls_from(goal, "goal"), times](EditSession& session, Execution& execution) {
    if (times.time_budget) execution.set_time_budget(*times.time_budget, BudgetEnd::after_checkpoint);
    return session.drag(to, execution, times.hand_over);
  };
}

EditResult settle_session(EditSession& session, Execution& execution) { return session.settle(execution); }
EditResult confirm_session(EditSession& session, Execution& execution) { return session.confirm(execution); }

EditSession make_session(SurfacePointer surface, DeformationPointer deformation, const Controls& controls,
                         const EditOptions& options, const Obstacles& obstacles, Execution& execution) {
  if (obstacles.empty()) return {std::move(surface), std::move(deformation), controls, options, execution};
  return {std::move(surface), std::move(deformation), controls, options, obstacles, execution};
}

/// The session as Python sees it.
class Session : public std::enable_shared_from_this<Session> {
 public:
  Session(SurfacePointer surface, DeformationPointer deformation, const Controls& controls, const EditOptions& options,
          const Obstacles& obstacles, Execution& execution)
      : threads_(options.threads),
        session_(make_session(std::move(surface), std::move(deformation), controls, options, obstacles, execution)) {}

  static std::shared_ptr<Session> open(SurfacePointer surface, DeformationPointer deformation,
                                       const DoubleArray& controls, const EditOptions& options,
                                       const Obstacles& obstacles) {
    const Controls start = controls_from(controls, "controls");
    const py::gil_scoped_release unlocked;
    Execution execution(std::max(0, options.threads));
    return std::make_shared<Session>(std::move(surface), std::move(deformation), start, options, obstacles, execution);
  }

  static std::unique_ptr<NativeJob> start(SurfacePointer surface, DeformationPointer deformation,
                                          const DoubleArray& controls, const EditOptions& options,
                                          const Obstacles& obstacles) {
    return start_job(
        std::max(0, options.threads),
        [=, start = controls_from(controls, "controls")](Execution& execution) {
          return std::make_shared<Session>(surface, deformation, start, options, obstacles, execution);
        },
        [](const std::shared_ptr<Session>& session) { return py::cast(session); });
  }

  py::dict call(const SessionCall& work, const CancelToken* cancel, const py::object& progress) {
    const InUse in_use(in_use_);
    Execution execution(threads_);
    if (cancel != nullptr) execution.cancel_when([cancel] { return cancel->cancelled.load(); });
    const ProgressCall progress_call(progress, execution);
    EditResult result;
    {
      const py::gil_scoped_release unlocked;
      result = work(session_, execution);
    }
    progress_call.rethrow();
    return dict_of(result);
  }

  /// The session is in use until the job is done.
  std::unique_ptr<NativeJob> start_call(const SessionCall& work) {
    auto in_use = std::make_shared<std::optional<InUse>>(std::in_place, in_use_);
    const auto carry_out = [self = shared_from_this(), in_use, work](Execution& execution) {
      const std::shared_ptr<void> at_end(nullptr, [&](void*) { in_use->reset(); });
      return work(self->session_, execution);
    };
    return start_job(threads_, carry_out, [](const EditResult& result) { return dict_of(result); });
  }

  void restore(const DoubleArray& controls, const std::optional<DoubleArray>& goal) {
    const Controls to = controls_from(controls, "controls");
    const Controls toward = goal ? controls_from(*goal, "goal") : to;
    const InUse in_use(in_use_);
    const py::gil_scoped_release unlocked;
    session_.restore(to, toward);
  }

  void set_weights(Eigen::VectorXd weights, std::vector<Eigen::Matrix3d> weight_axes) {
    const InUse in_use(in_use_);
    const py::gil_scoped_release unlocked;
    session_.set_weights(std::move(weights), std::move(weight_axes));
  }

  void end_drag() {
    const InUse in_use(in_use_);
    const py::gil_scoped_release unlocked;
    session_.end_drag();
  }

  Controls controls() {
    const InUse in_use(in_use_);
    return session_.controls();
  }
  Positions surface() {
    const InUse in_use(in_use_);
    return session_.surface();
  }
  double separation() const { return session_.separation(); }
  Edges excluded() {
    const InUse in_use(in_use_);
    return as_rows(session_.excluded());
  }

  bool is_step_free(const PositionsView& start, const PositionsView& end) {
    const InUse in_use(in_use_);
    const py::gil_scoped_release unlocked;
    Execution execution(threads_);
    return session_.is_step_free(start, end, execution);
  }

  std::shared_ptr<DeviationTest> deviation_test() {
    const InUse in_use(in_use_);
    return std::const_pointer_cast<DeviationTest>(session_.deviation_test());
  }

  py::object least_distance(bool within) {
    const InUse in_use(in_use_);
    return tuple_of([&] {
      const py::gil_scoped_release unlocked;
      return session_.least_distance(within ? DistancePairs::all : DistancePairs::between_bodies);
    }());
  }

 private:
  int threads_;
  EditSession session_;
  std::atomic<bool> in_use_{false};
};

Obstacles as_obstacles(const std::vector<std::shared_ptr<Obstacle>>& given) { return {given.begin(), given.end()}; }

void bind_options(py::module_& module) {
  py::class_<StorageFrame>(module, "StorageFrame")
      .def(py::init([](Index first, Index count, const Eigen::Matrix4d& frame) {
             return StorageFrame{first, count, frame};
           }),
           py::arg("first"), py::arg("count"), py::arg("frame"));
  py::class_<BodyPairSeparation>(module, "BodyPairSeparation")
      .def(py::init([](Index first, Index second, double separation) {
             return BodyPairSeparation{first, second, separation};
           }),
           py::arg("first"), py::arg("second"), py::arg("separation"));
  py::native_enum<ConstraintKind>(module, "ConstraintKind", "enum.Enum")
      .value("per_patch", ConstraintKind::per_patch)
      .value("single", ConstraintKind::single)
      .finalize();
  py::native_enum<ConstraintSolver>(module, "ConstraintSolver", "enum.Enum")
      .value("lcp", ConstraintSolver::lcp)
      .value("linear", ConstraintSolver::linear)
      .finalize();
  py::native_enum<MetricKind>(module, "MetricKind", "enum.Enum")
      .value("energy", MetricKind::energy)
      .value("controls", MetricKind::controls)
      .finalize();
  py::native_enum<VolumeKind>(module, "VolumeKind", "enum.Enum")
      .value("relative", VolumeKind::relative)
      .value("published", VolumeKind::published)
      .value("published_frozen", VolumeKind::published_frozen)
      .finalize();
  py::class_<EditOptions>(module, "EditOptions")
      .def(py::init<>())
      .def_readwrite("separation", &EditOptions::separation)
      .def_readwrite("pair_separations", &EditOptions::pair_separations)
      .def_readwrite("min_clearance_ratio", &EditOptions::min_clearance_ratio)
      .def_readwrite("min_clearance_ratio_between", &EditOptions::min_clearance_ratio_between)
      .def_readwrite("smoothness", &EditOptions::smoothness)
      .def_readwrite("tight", &EditOptions::tight)
      .def_readwrite("weights", &EditOptions::weights)
      .def_readwrite("weight_axes", &EditOptions::weight_axes)
      .def_readwrite("exclude", &EditOptions::excluded)
      .def_readwrite("parts_may_cut", &EditOptions::parts_may_cut)
      .def_readwrite("overlapping", &EditOptions::overlapping)
      .def_readwrite("touching", &EditOptions::touching)
      .def_readwrite("constraints", &EditOptions::constraints)
      .def_readwrite("solver", &EditOptions::solver)
      .def_readwrite("metric", &EditOptions::metric)
      .def_readwrite("volumes", &EditOptions::volumes)
      .def_readwrite("narrow_phase", &EditOptions::narrow_phase)
      .def_readwrite("broad_phase", &EditOptions::broad_phase)
      .def_readwrite("max_sub_edits", &EditOptions::max_sub_edits)
      .def_readwrite("max_rounds", &EditOptions::max_rounds)
      .def_readwrite("accumulated_rounds", &EditOptions::accumulated_rounds)
      .def_readwrite("pull_limit", &EditOptions::pull_limit)
      .def_readwrite("single_precision", &EditOptions::single_precision)
      .def_readwrite("storage", &EditOptions::storage)
      .def_readwrite("time_budget", &EditOptions::time_budget)
      .def_readwrite("threads", &EditOptions::threads);
}

}  // namespace

void bind_obstacle(py::module_& module) {
  py::class_<Obstacle, std::shared_ptr<Obstacle>>(module, "Obstacle")
      .def(py::init([](std::string name, Positions positions, Triangles triangles) {
             const py::gil_scoped_release unlocked;
             return std::make_shared<Obstacle>(std::move(name), std::move(positions), std::move(triangles));
           }),
           py::arg("name"), py::arg("positions"), py::arg("triangles"))
      .def_property_readonly("positions", &Obstacle::positions)  // views
      .def_property_readonly("triangles", &Obstacle::triangles)
      .def(
          "triangles_near",
          [](const Obstacle& obstacle, const Vector3& low, const Vector3& high) {
            const std::vector<Index> near = obstacle.triangles_near({low, high}, Execution(0));
            return py::array_t<Index>(static_cast<py::ssize_t>(near.size()), near.data());
          },
          py::arg("low"), py::arg("high"));
}

void bind_editing(py::module_& module) {
  bind_options(module);
  py::class_<CancelToken>(module, "CancelToken", "Cancels a call from any thread.")
      .def(py::init<>())
      .def("cancel", [](CancelToken& token) { token.cancelled = true; })
      .def_property_readonly("cancelled", [](const CancelToken& token) { return token.cancelled.load(); });
  const auto cancel = py::arg("cancel") = static_cast<CancelToken*>(nullptr);
  const auto progress = py::arg("progress") = py::none();
  const py::arg surface("surface"), deformation("deformation"), controls("controls"), options("options"), goal("goal"),
      obstacles("obstacles");
  using GivenObstacles = std::vector<std::shared_ptr<Obstacle>>;
  const auto time_budget = py::arg("time_budget") = py::none();
  const auto hand_over = py::arg("hand_over") = py::none();
  using Token = const CancelToken*;
  py::class_<Session, std::shared_ptr<Session>>(module, "EditSession")
      .def(py::init([](std::shared_ptr<Surface> from, std::shared_ptr<Deformation> map, const DoubleArray& start,
                       const EditOptions& chosen, const GivenObstacles& beside) {
             return Session::open(from, map, start, chosen, as_obstacles(beside));
           }),
           surface, deformation, controls, options, obstacles)
      .def_static(
          "start",
          [](std::shared_ptr<Surface> from, std::shared_ptr<Deformation> map, const DoubleArray& start,
             const EditOptions& chosen,
             const GivenObstacles& beside) { return Session::start(from, map, start, chosen, as_obstacles(beside)); },
          surface, deformation, controls, options, obstacles)
      .def(
          "edit",
          [](Session& session, const DoubleArray& to, Token token, const py::object& report) {
            return session.call(edit_to(to), token, report);
          },
          goal, cancel, progress)
      .def(
          "drag",
          [](Session& session, const DoubleArray& to, Token token, const py::object& report,
             const std::optional<double>& budget, const std::optional<double>& after) {
            return session.call(drag_to(to, {budget, after}), token, report);
          },
          goal, cancel, progress, time_budget, hand_over)
      .def(
          "settle",
          [](Session& session, Token token, const py::object& report) {
            return session.call(settle_session, token, report);
          },
          cancel, progress)
      .def(
          "confirm",
          [](Session& session, Token token, const py::object& report) {
            return session.call(confirm_session, token, report);
          },
          cancel, progress)
      .def(
          "start_edit", [](Session& session, const DoubleArray& to) { return session.start_call(edit_to(to)); }, goal)
      .def(
          "start_drag",
          [](Session& session, const DoubleArray& to, const std::optional<double>& budget,
             const std::optional<double>& after) {
            return session.start_call(drag_to(to, {budget, after}));
          },
          goal, time_budget, hand_over)
      .def("start_settle", [](Session& session) { return session.start_call(settle_session); })
      .def("start_confirm", [](Session& session) { return session.start_call(confirm_session); })
      .def("restore", &Session::restore, py::arg("controls"), py::arg("goal"))
      .def("set_weights", &Session::set_weights, py::arg("weights"), py::arg("weight_axes"))
      .def("is_step_free", &Session::is_step_free, py::arg("start"), py::arg("end"))
      .def("deviation_test", &Session::deviation_test)
      .def("end_drag", &Session::end_drag)
      .def("least_distance", &Session::least_distance, py::arg("within"))
      .def_property_readonly("controls", &Session::controls)
      .def_property_readonly("surface", &Session::surface)
      .def_property_readonly("separation", &Session::separation)
      .def_property_readonly("excluded", &Session::excluded);
}

}  // namespace stiv::bindings
