// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/repair/repair.hpp"

#include <algorithm>
#include <memory>

#include "calls.hpp"
#include "conversions.hpp"
#include "job.hpp"
#include "module.hpp"
#include "stiv/repair/contraction.hpp"

namespace stiv::bindings {

namespace {

using SurfacePointer = std::shared_ptr<Surface>;
using DeformationPointer = std::shared_ptr<Deformation>;

/// Without a deformation every vertex is a control.
CagedSurface caged_surface(const SurfacePointer& surface, const DeformationPointer& deformation,
                           const SurfacePointer& cage) {
  if (deformation == nullptr) return without_cage(surface);
  return {surface, deformation, cage};
}

const char* name_of(RepairStatus status) {
  switch (status) {
    case RepairStatus::already_free:
      return "already_free";
    case RepairStatus::repaired:
      return "repaired";
    case RepairStatus::refused:
      return "refused";
    case RepairStatus::cancelled:
      return "cancelled";
    case RepairStatus::budget:
      return "budget";
  }
  return "";
}

const char* name_of(RepairRefusal refusal) {
  switch (refusal) {
    case RepairRefusal::none:
      return "";
    case RepairRefusal::coincident:
      return "coincident";
    case RepairRefusal::held:
      return "held";
    case RepairRefusal::not_freed:
      return "not_freed";
    case RepairRefusal::too_far:
      return "too_far";
  }
  return "";
}

py::dict dict_of(const ContractionResult& result) {
  py::dict values;
  values["positions"] = result.positions;
  values["free"] = result.free;
  values["pairs"] = result.pairs;
  values["out_of_time"] = result.out_of_time;
  return values;
}

py::dict dict_of(const RepairResult& result) {
  py::dict values;
  values["status"] = name_of(result.status);
  values["refusal"] = name_of(result.refusal);
  values["out_of_time"] = result.out_of_time;
  values["positions"] = result.positions;
  values["pairs"] = as_rows(result.pairs.faces);
  values["loose_edge_pairs"] = as_rows(result.pairs.loose_edges);
  values["loose_vertex_pairs"] = as_rows(result.pairs.loose_vertices);
  values["pairs_before"] = result.pairs_before;
  values["fewest_pairs"] = result.fewest_pairs;
  values["steps"] = result.steps;
  values["deviation"] = result.deviation;
  values["contracted"] = result.contracted;
  values["counters"] = bindings::dict_of(result.counters);
  values["timings"] = bindings::dict_of(result.timings);
  return values;
}

/// Runs work of the core without Python's lock, with its progress and cancellation.
template <class Work>
auto call(int threads, const CancelToken* cancel, const py::object& progress, const Work& work) {
  Execution execution(threads);
  if (cancel != nullptr) execution.cancel_when([cancel] { return cancel->cancelled.load(); });
  const ProgressCall progress_call(progress, execution);
  auto result = [&] {
    const py::gil_scoped_release unlocked;
    return work(execution);
  }();
  progress_call.rethrow();
  return result;
}

Positions step(const SurfacePointer& surface, const Positions& start, const Positions& q,
               const std::vector<unsigned char>& moves, double smoothing) {
  surface->check_positions(q);
  return contraction_step(*surface, contraction_system(*surface, start, moves), q, smoothing);
}

std::unique_ptr<NativeJob> start_step(const SurfacePointer& surface, const Positions& start, const Positions& q,
                                      const std::vector<unsigned char>& moves, double smoothing) {
  return start_job(
      1,
      [=](Execution& execution) {
        execution.check();
        return step(surface, start, q, moves, smoothing);
      },
      [](const Positions& result) { return py::cast(result); });
}

auto contraction_of(const SurfacePointer& surface, const Controls& p, const std::vector<unsigned char>& moves,
                    const ContractionOptions& options, const DeformationPointer& deformation,
                    const SurfacePointer& cage) {
  return [=](Execution& execution) {
    try {
      return contract(caged_surface(surface, deformation, cage), p, moves, options, execution);
    } catch (const Interrupted&) {
      return ContractionResult{p, false, {}, false};
    }
  };
}

auto expansion_of(const SurfacePointer& surface, const Controls& from, const Controls& target,
                  const EditOptions& options, const DeformationPointer& deformation) {
  return [=](Execution& execution) {
    return expand(surface, caged_surface(surface, deformation, surface).deformation, from, target, options, execution);
  };
}

auto repair_of(const SurfacePointer& surface, const Controls& p, const RepairOptions& options,
               const DeformationPointer& deformation, const SurfacePointer& cage) {
  return [=](Execution& execution) { return repair(caged_surface(surface, deformation, cage), p, options, execution); };
}

py::dict run_contraction(const SurfacePointer& surface, const Controls& p, const std::vector<unsigned char>& moves,
                         const ContractionOptions& options, int threads, const DeformationPointer& deformation,
                         const SurfacePointer& cage, const CancelToken* cancel, const py::object& progress) {
  return dict_of(call(threads, cancel, progress, contraction_of(surface, p, moves, options, deformation, cage)));
}

py::dict run_expansion(const SurfacePointer& surface, const Controls& from, const Controls& target,
                       const EditOptions& options, const DeformationPointer& deformation, const CancelToken* cancel,
                       const py::object& progress) {
  return bindings::dict_of(
      call(options.threads, cancel, progress, expansion_of(surface, from, target, options, deformation)));
}

py::dict run_repair(const SurfacePointer& surface, const Controls& p, const RepairOptions& options,
                    const DeformationPointer& deformation, const SurfacePointer& cage, const CancelToken* cancel,
                    const py::object& progress) {
  return dict_of(call(options.edit.threads, cancel, progress, repair_of(surface, p, options, deformation, cage)));
}

std::unique_ptr<NativeJob> start_contraction(const SurfacePointer& surface, const Controls& p,
                                             const std::vector<unsigned char>& moves, const ContractionOptions& options,
                                             int threads, const DeformationPointer& deformation,
                                             const SurfacePointer& cage) {
  return start_job(threads, contraction_of(surface, p, moves, options, deformation, cage),
                   [](const ContractionResult& result) { return dict_of(result); });
}

std::unique_ptr<NativeJob> start_expansion(const SurfacePointer& surface, const Controls& from, const Controls& target,
                                           const EditOptions& options, const DeformationPointer& deformation) {
  return start_job(std::max(0, options.threads), expansion_of(surface, from, target, options, deformation),
                   [](const EditResult& result) { return bindings::dict_of(result); });
}

std::unique_ptr<NativeJob> start_repair(const SurfacePointer& surface, const Controls& p, const RepairOptions& options,
                                        const DeformationPointer& deformation, const SurfacePointer& cage) {
  return start_job(std::max(0, options.edit.threads), repair_of(surface, p, options, deformation, cage),
                   [](const RepairResult& result) { return dict_of(result); });
}

}  // namespace

void bind_repair(py::module_& module) {
  py::class_<ContractionOptions>(module, "ContractionOptions")
      .def(py::init<>())
      .def_readwrite("smoothing", &ContractionOptions::smoothing)
      .def_readwrite("growth", &ContractionOptions::growth)
      .def_readwrite("max_steps", &ContractionOptions::max_steps)
      .def_readwrite("tolerance", &ContractionOptions::tolerance)
      .def_readwrite("time_budget", &ContractionOptions::time_budget)
      .def_readwrite("storage", &ContractionOptions::storage);
  py::class_<RepairOptions>(module, "RepairOptions")
      .def(py::init<>())
      .def_readwrite("contraction", &RepairOptions::contraction)
      .def_readwrite("edit", &RepairOptions::edit)
      .def_readwrite("moves", &RepairOptions::moves)
      .def_readwrite("good_deviation", &RepairOptions::good_deviation)
      .def_readwrite("max_deviation", &RepairOptions::max_deviation);
  const py::arg surface("surface"), positions("positions"), moves("moves"), options("options");
  const auto deformation = py::arg("deformation") = DeformationPointer();
  const auto cage = py::arg("cage") = SurfacePointer();
  const auto cancel = py::arg("cancel") = static_cast<CancelToken*>(nullptr);
  const auto progress = py::arg("progress") = py::none();
  module.def("contraction_step", &step, surface, py::arg("start"), positions, moves, py::arg("smoothing"),
             py::call_guard<py::gil_scoped_release>());
  module.def("start_contraction_step", &start_step, surface, py::arg("start"), positions, moves, py::arg("smoothing"));
  module.def("contract", &run_contraction, surface, positions, moves, options, py::arg("threads"), deformation, cage,
             cancel, progress);
  module.def("expand", &run_expansion, surface, positions, py::arg("target"), options, deformation, cancel, progress);
  module.def("repair", &run_repair, surface, positions, options, deformation, cage, cancel, progress);
  module.def("start_contraction", &start_contraction, surface, positions, moves, options, py::arg("threads"),
             deformation, cage);
  module.def("start_expansion", &start_expansion, surface, positions, py::arg("target"), options, deformation);
  module.def("start_repair", &start_repair, surface, positions, options, deformation, cage);
}

}  // namespace stiv::bindings
