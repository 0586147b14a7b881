// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/editing/repair.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "editing/contraction_tries.hpp"
#include "stiv/editing/expansion.hpp"
#include "stiv/error.hpp"

namespace stiv {

namespace {

/// The marks given, without what does not belong to a deformable body.
Marks movable_vertices(const Surface& surface, const Marks& asked) {
  const auto count = static_cast<std::size_t>(surface.vertex_count());
  if (!asked.empty() && asked.size() != count)
    throw InputError("the marks of what may move have " + std::to_string(asked.size()) + " entries, the surface has " +
                     std::to_string(count) + " vertices");
  Marks movable(count);
  for (std::size_t k = 0; k < count; ++k) {
    const auto body = static_cast<std::size_t>(surface.body_of(static_cast<Index>(k)));
    movable[k] = surface.bodies()[body].mobility == Mobility::deformable && (asked.empty() || asked[k] != 0);
  }
  return movable;
}

bool any_coincide(const Surface& surface, const Positions& q, const StaticPairs& pairs) {
  const auto corners = [&](Index triangle) {
    std::array<std::array<double, 3>, 3> places;
    for (Index k = 0; k < 3; ++k) {
      const auto row = q.row(surface.triangles()(triangle, k));
      places[static_cast<std::size_t>(k)] = {row[0], row[1], row[2]};
    }
    std::sort(places.begin(), places.end());
    return places;
  };
  return std::any_of(pairs.faces.begin(), pairs.faces.end(),
                     [&](const auto& pair) { return corners(pair.first) == corners(pair.second); });
}

bool any_held(const Surface& surface, const StaticPairs& pairs, const Marks& movable) {
  const auto moves = [&](Index vertex) { return movable[static_cast<std::size_t>(vertex)] != 0; };
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
    if (marks[static_cast<std::size_t>(vertex)] == 0) continue;
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
  Repair(std::shared_ptr<const Surface> surface, const Positions& q, RepairOptions options, Execution& execution)
      : surface_(std::move(surface)),
        start_(q),
        options_(std::move(options)),
        movable_(movable_vertices(*surface_, options_.moves)),
        test_(surface_),
        execution_(execution) {
    surface_->check_positions(q);
    if (options_.edit.single_precision && options_.edit.storage.empty())
      options_.edit.storage.push_back({0, surface_->vertex_count(), Eigen::Matrix4d::Identity()});
    if (!options_.edit.single_precision) options_.edit.storage.clear();
    options_.contraction.storage = options_.edit.storage;
    options_.edit.weights = Eigen::Map<const Eigen::Array<unsigned char, Eigen::Dynamic, 1>>(
                                movable_.data(), static_cast<Index>(movable_.size()))
                                .cast<double>();
    if (options_.edit.time_budget > 0) execution.set_time_budget(options_.edit.time_budget);
    options_.edit.time_budget = 0;
  }

  RepairResult run() {
    result_.positions = start_;
    try {
      result_.pairs = find_static_pairs(test_, start_, execution_);
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
    if (any_coincide(*surface_, start_, result_.pairs)) return refuse(RepairRefusal::coincident);
    if (any_held(*surface_, result_.pairs, movable_)) return refuse(RepairRefusal::held);
    Positions fewest = start_;
    for (const ContractionTry& way : contraction_tries(surface_, result_.pairs, movable_, options_.contraction)) {
      follow(way, start_, fewest);
      if (is_good()) return conclude();
    }
    // What no try freed from the start, parts around what is left may free from the best of them.
    if (!best_found_ && fewest != start_) {
      const Positions best = fewest;
      follow(regions_try(), best, fewest);
    }
    conclude();
  }

  ContractionTry regions_try() const {
    return contraction_tries(surface_, result_.pairs, movable_, options_.contraction).back();
  }

  void follow(const ContractionTry& way, const Positions& from, Positions& fewest) {
    execution_.check();
    const Contracted contracted = way.run(from, execution_);
    result_.steps += contracted.steps;
    if (contracted.pairs < result_.fewest_pairs) {
      result_.fewest_pairs = contracted.pairs;
      fewest = contracted.positions;
    }
    if (contracted.pairs == 0) expand_back(contracted.positions, way.what);
  }

  void expand_back(const Positions& contracted, const std::string& what) {
    EditResult expanded = expand(surface_, contracted, start_, options_.edit, execution_);
    if (execution_.cancel_requested()) throw Interrupted("cancelled");
    const double deviation = relative_deviation(start_, expanded.surface, movable_);
    if (best_found_ && deviation >= result_.deviation) return;
    best_found_ = true;
    best_ = std::move(expanded.surface);
    result_.deviation = deviation;
    result_.contracted = what;
  }

  bool is_good() const { return best_found_ && result_.deviation <= options_.good_deviation; }

  void refuse(RepairRefusal reason) {
    result_.status = RepairStatus::refused;
    result_.refusal = reason;
  }

  /// Takes the best repair if it is near enough, and if the exact test of all says once more that nothing intersects.
  void conclude() {
    if (!best_found_) return refuse(RepairRefusal::not_freed);
    if (result_.deviation > options_.max_deviation) return refuse(RepairRefusal::too_far);
    Execution uninterrupted(execution_.threads());
    if (!find_static_pairs(test_, best_, uninterrupted).empty()) return refuse(RepairRefusal::not_freed);
    result_.status = RepairStatus::repaired;
    result_.positions = best_;
    result_.pairs = {};
  }

  std::shared_ptr<const Surface> surface_;
  const Positions& start_;
  RepairOptions options_;
  Marks movable_;
  IntersectionTest test_;
  Execution& execution_;
  RepairResult result_;
  bool best_found_ = false;
  Positions best_;
};

}  // namespace

RepairResult repair(const std::shared_ptr<const Surface>& surface, const Positions& q, const RepairOptions& options,
                    Execution& execution) {
  const FloatingPointScope floating_point;
  return Repair(surface, q, options, execution).run();
}

}  // namespace stiv
