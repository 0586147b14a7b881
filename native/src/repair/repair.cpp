// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/repair/repair.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "repair/contraction_tries.hpp"
#include "stiv/error.hpp"
#include "stiv/repair/expansion.hpp"

namespace stiv {

namespace {

constexpr int further_rounds = 4;

/// The marks given, without controls that move anything but deformable bodies.
Movable movable_of(const CagedSurface& caged, const Marks& asked) {
  const auto count = static_cast<std::size_t>(caged.deformation->control_count());
  if (!asked.empty() && asked.size() != count)
    throw InputError("the marks of what may move have " + std::to_string(asked.size()) + " entries, there are " +
                     std::to_string(count) + " controls");
  const Surface& surface = *caged.surface;
  const auto is_deformable = [&](Index vertex) {
    return surface.bodies()[at(surface.body_of(vertex))].mobility == Mobility::deformable;
  };
  Movable movable{Marks(count), {}, supports_of(*caged.deformation)};
  for (std::size_t k = 0; k < count; ++k) {
    const std::vector<Index>& support = movable.supports[k];
    movable.controls[k] =
        (asked.empty() || asked[k] != 0) && std::all_of(support.begin(), support.end(), is_deformable);
  }
  movable.vertices = moved_by(movable.controls, movable.supports, surface.vertex_count());
  return movable;
}

bool any_coincide(const Surface& surface, const Positions& q, const StaticPairs& pairs) {
  const auto corners = [&](Index triangle) {
    std::array<std::array<double, 3>, 3> places;
    for (Index k = 0; k < 3; ++k) {
      const auto row = q.row(surface.triangles()(triangle, k));
      places[at(k)] = {row[0], row[1], row[2]};
    }
    std::sort(places.begin(), places.end());
    return places;
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

/// One repair: the tries in their order, the best expansion so far, and what is to be said when none is good.
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
    options_.edit.weights = Eigen::Map<const Eigen::Array<unsigned char, Eigen::Dynamic, 1>>(
                                movable_.controls.data(), static_cast<Index>(movable_.controls.size()))
                                .cast<double>();
    if (options_.edit.time_budget > 0) execution.set_time_budget(options_.edit.time_budget);
    options_.edit.time_budget = 0;
  }

  RepairResult run() {
    result_.positions = start_;
    try {
      result_.pairs = find_static_pairs(test_, surface_at_start_, execution_);
      result_.pairs_before = result_.fewest_pairs = result_.pairs.count();
      if (!result_.pairs.empty()) untangle();
    } catch (const Interrupted&) {
      if (!best_found_ || execution_.cancel_requested())
        result_.status = execution_.cancel_requested() ? RepairStatus::cancelled : RepairStatus::budget;
      else
        conclude();
    }
    result_.counters = execution_.counters;
    result_.timings = execution_.timings;
    return std::move(result_);
  }

 private:
  void untangle() {
    if (any_coincide(*caged_.surface, surface_at_start_, result_.pairs)) return refuse(RepairRefusal::coincident);
    if (any_held(*caged_.surface, result_.pairs, movable_.vertices)) return refuse(RepairRefusal::held);
    Controls fewest = start_;
    for (const ContractionTry& way : contraction_tries(caged_, result_.pairs, movable_, options_.contraction)) {
      follow(way, start_, fewest);
      if (is_good()) return conclude();
    }
    // What no try freed from the start, parts around what is left may free from the best of them.
    if (!best_found_ && fewest != start_) {
      const Controls best = fewest;
      follow(regions_try(), best, fewest);
    }
    conclude();
  }

  ContractionTry regions_try() const {
    return contraction_tries(caged_, result_.pairs, movable_, options_.contraction).back();
  }

  void follow(const ContractionTry& way, const Controls& from, Controls& fewest) {
    execution_.check();
    const Contracted contracted = way.run(from, execution_);
    result_.steps += contracted.steps;
    if (contracted.pairs < result_.fewest_pairs) {
      result_.fewest_pairs = contracted.pairs;
      fewest = contracted.positions;
    }
    if (contracted.pairs == 0) expand_back(contracted.positions, way.what);
  }

  void expand_back(const Controls& contracted, const std::string& what) {
    EditResult expanded = expand(caged_.surface, caged_.deformation, contracted, start_, options_.edit, execution_);
    if (execution_.cancel_requested()) throw Interrupted("cancelled");
    const double deviation = relative_deviation(surface_at_start_, expanded.surface, movable_.vertices);
    if (best_found_ && deviation >= result_.deviation) return;
    best_found_ = true;
    best_ = std::move(expanded.controls);
    result_.deviation = deviation;
    result_.contracted = what;
  }

  /// A new edit from the best repair sometimes comes nearer: other contacts are met first.
  void come_nearer() {
    for (int round = 0; round < further_rounds && !is_good(); ++round) {
      const double before = result_.deviation;
      expand_back(Controls(best_), result_.contracted);
      if (!(result_.deviation < before)) return;
    }
  }

  bool is_good() const { return best_found_ && result_.deviation <= options_.good_deviation; }

  void refuse(RepairRefusal reason) {
    result_.status = RepairStatus::refused;
    result_.refusal = reason;
  }

  /// Takes the best repair if it is near enough, and if the exact test of all says once more that nothing intersects.
  void conclude() {
    if (!best_found_) return refuse(RepairRefusal::not_freed);
    if (!execution_.budget_used_up()) come_nearer();
    if (result_.deviation > options_.max_deviation) return refuse(RepairRefusal::too_far);
    Execution uninterrupted(execution_.threads());
    if (!find_static_pairs(test_, caged_.deformation->surface_in_range(best_), uninterrupted).empty())
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
