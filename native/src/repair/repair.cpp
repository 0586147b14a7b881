// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/repair/repair.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "repair/contraction_strategies.hpp"
#include "stiv/error.hpp"
#include "stiv/repair/contraction.hpp"

namespace stiv {

namespace {

constexpr int refinement_rounds = 4;

/// The requested controls, without those that move vertices of bodies that are not deformable.
Movable movable_of(const CagedSurface& caged, const Marks& requested) {
  const auto count = static_cast<std::size_t>(caged.deformation->control_count());
  if (!requested.empty() && requested.size() != count)
    throw InputError("moves has " + std::to_string(requested.size()) + " entries, there are " + std::to_string(count) +
                     " controls");
  const Surface& surface = *caged.surface;
  const auto is_deformable = [&](Index vertex) {
    return surface.bodies()[at(surface.body_of(vertex))].mobility == Mobility::deformable;
  };
  Movable movable{Marks(count), {}, supports_of(*caged.deformation)};
  for (std::size_t k = 0; k < count; ++k) {
    const std::vector<Index>& support = movable.supports[k];
    movable.controls[k] =
        (requested.empty() || requested[k] != 0) && std::all_of(support.begin(), support.end(), is_deformable);
  }
  movable.vertices = vertices_moved(movable.controls, movable.supports, surface.vertex_count());
  return movable;
}

bool any_coincide(const Surface& surface, const Positions& q, const StaticPairs& pairs) {
  const auto corners = [&](Index triangle) {
    std::array<std::array<double, 3>, 3> points;
    for (Index k = 0; k < 3; ++k) {
      const auto row = q.row(surface.triangles()(triangle, k));
      points[at(k)] = {row[0], row[1], row[2]};
    }
    std::sort(points.begin(), points.end());
    return points;
  };
  return std::any_of(pairs.faces.begin(), pairs.faces.end(),
                     [&](const auto& pair) { return corners(pair.first) == corners(pair.second); });
}

bool any_held(const Surface& surface, const StaticPairs& pairs, const Marks& movable) {
  const auto moves = [&](Index vertex) { return movable[at(vertex)] != 0; };
  const auto vertices = vertices_of_pairs(surface, pairs);
  return std::any_of(vertices.begin(), vertices.end(),
                     [&](const auto& pair) { return std::none_of(pair.begin(), pair.end(), moves); });
}

/// Root mean square distance over the marked vertices, in diagonals of their bounding box.
double relative_deviation(const Positions& from, const Positions& to, const Marks& marks) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Eigen::RowVector3d low = Eigen::RowVector3d::Constant(infinity), high = -low;
  double sum = 0, count = 0;
  for (Index vertex = 0; vertex < from.rows(); ++vertex) {
    if (marks[at(vertex)] == 0) continue;
    low = low.cwiseMin(from.row(vertex));
    high = high.cwiseMax(from.row(vertex));
    sum += (to.row(vertex) - from.row(vertex)).squaredNorm();
    count += 1;
  }
  if (sum == 0) return 0;
  const double diagonal = (high - low).norm();
  return diagonal > 0 ? std::sqrt(sum / count) / diagonal : infinity;
}

/// Runs the strategies in order and remembers the best expansion.
class Repair {
 public:
  Repair(CagedSurface caged, const Controls& p, RepairOptions options, Execution& execution)
      : caged_(std::move(caged)),
        start_(p),
        surface_at_start_(caged_.deformation->surface_in_range(p)),
        options_(std::move(options)),
        movable_(movable_of(caged_, options_.moves)),
        test_(caged_.surface),
        execution_(execution) {
    if (options_.edit.single_precision && options_.edit.storage.empty())
      options_.edit.storage.push_back({0, static_cast<Index>(p.rows()), Eigen::Matrix4d::Identity()});
    if (!options_.edit.single_precision) options_.edit.storage.clear();
    options_.contraction.storage = options_.edit.storage;
    options_.contraction.time_budget = 0;
    options_.edit.weights = Eigen::Map<const Eigen::Array<unsigned char, Eigen::Dynamic, 1>>(
                                movable_.controls.data(), static_cast<Index>(movable_.controls.size()))
                                .cast<double>();
    if (options_.edit.time_budget > 0) execution.set_time_budget(options_.edit.time_budget);
    options_.edit.time_budget = 0;
  }

  RepairResult run() {
    result_.positions = start_;
    try {
      result_.pairs = test_.find_all(surface_at_start_, execution_);
      result_.pairs_before = result_.fewest_pairs = result_.pairs.count();
      if (!result_.pairs.empty()) try_strategies();
    } catch (const Interrupted&) {
      result_.out_of_time = !execution_.cancel_requested();
      if (!best_found_ || !result_.out_of_time)
        result_.status = result_.out_of_time ? RepairStatus::budget : RepairStatus::cancelled;
      else
        conclude();
    }
    result_.counters = execution_.counters;
    result_.timings = execution_.timings;
    return std::move(result_);
  }

 private:
  void try_strategies() {
    if (any_coincide(*caged_.surface, surface_at_start_, result_.pairs)) return refuse(RepairRefusal::coincident);
    if (any_held(*caged_.surface, result_.pairs, movable_.vertices)) return refuse(RepairRefusal::held);
    Controls fewest = start_;
    for (const ContractionStrategy& strategy :
         contraction_strategies(caged_, result_.pairs, movable_, options_.contraction)) {
      apply(strategy, start_, fewest);
      if (is_good()) return conclude();
    }
    // Contracting regions from the best state may remove the pairs that every strategy left.
    if (!best_found_ && fewest != start_) {
      const Controls best = fewest;
      apply(regions_strategy(), best, fewest);
    }
    conclude();
  }

  ContractionStrategy regions_strategy() const {
    return contraction_strategies(caged_, result_.pairs, movable_, options_.contraction).back();
  }

  void apply(const ContractionStrategy& strategy, const Controls& from, Controls& fewest) {
    execution_.check();
    const Contracted contracted = strategy.run(from, execution_);
    result_.steps += contracted.steps;
    if (contracted.pairs < result_.fewest_pairs) {
      result_.fewest_pairs = contracted.pairs;
      fewest = contracted.positions;
    }
    if (contracted.pairs == 0) expand_back(contracted.positions, strategy.name);
  }

  void expand_back(const Controls& contracted, const std::string& strategy) {
    EditResult expanded = expand(caged_.surface, caged_.deformation, contracted, start_, options_.edit, execution_);
    if (execution_.cancel_requested()) throw Interrupted("cancelled");
    const double deviation = relative_deviation(surface_at_start_, expanded.surface, movable_.vertices);
    if (best_found_ && deviation >= result_.deviation) return;
    best_found_ = true;
    best_ = std::move(expanded.controls);
    result_.deviation = deviation;
    result_.contracted = strategy;
  }

  /// Repeats the expansion from the best repair: contacts occur in another order, and the result may be closer.
  void refine() {
    for (int round = 0; round < refinement_rounds && !is_good(); ++round) {
      const double before = result_.deviation;
      expand_back(Controls(best_), result_.contracted);
      if (!(result_.deviation < before)) return;
    }
  }

  bool is_good() const { return best_found_ && result_.deviation <= options_.good_deviation; }

  void refuse(RepairRefusal reason) {
    if (result_.out_of_time) {
      result_.status = RepairStatus::budget;  // more time may find another repair
      return;
    }
    result_.status = RepairStatus::refused;
    result_.refusal = reason;
  }

  /// Accepts the best repair if its deviation is small enough and the exact test of the whole surface confirms it.
  void conclude() {
    if (!best_found_) return refuse(RepairRefusal::not_freed);
    result_.out_of_time = result_.out_of_time || execution_.budget_used_up();
    if (!result_.out_of_time) refine();
    if (result_.deviation > options_.max_deviation) return refuse(RepairRefusal::too_far);
    Execution uninterrupted(execution_.threads());
    if (!test_.find_all(caged_.deformation->surface_in_range(best_), uninterrupted).empty())
      return refuse(RepairRefusal::not_freed);
    result_.status = RepairStatus::repaired;
    result_.positions = best_;
    result_.pairs = {};
  }

  CagedSurface caged_;
  const Controls& start_;
  Positions surface_at_start_;
  RepairOptions options_;
  Movable movable_;
  IntersectionTest test_;
  Execution& execution_;
  RepairResult result_;
  bool best_found_ = false;
  Controls best_;
};

}  // namespace

RepairResult repair(const CagedSurface& caged, const Controls& p, const RepairOptions& options, Execution& execution) {
  check_caged(caged, p);
  const FloatingPointScope floating_point;
  return Repair(caged, p, options, execution).run();
}

}  // namespace stiv
