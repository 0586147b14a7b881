// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/validation.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "stiv/error.hpp"

namespace stiv {

namespace {

constexpr std::size_t pairs_named = 3;

void require(bool condition, const std::string& message) {
  if (!condition) throw InputError(message);
}

void check_weights(const Eigen::VectorXd& weights, Index control_count) {
  if (weights.size() == 0) return;
  const bool by_axis = weights.size() == 3 * control_count;
  require(by_axis || weights.size() == control_count, "weights has " + std::to_string(weights.size()) +
                                                          " entries for " + std::to_string(control_count) +
                                                          " controls: give one for each, or three");
  for (Index k = 0; k < weights.size(); ++k)
    require(std::isfinite(weights[k]) && weights[k] >= 0,
            "weights, control " + std::to_string(by_axis ? k / 3 : k) + ": must be finite and not negative");
}

void check_storage(const std::vector<StorageFrame>& frames, Index control_count) {
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const StorageFrame& storage = frames[k];
    const std::string name = "storage frame " + std::to_string(k);
    require(storage.first >= 0 && storage.count >= 0 && storage.count <= control_count - storage.first,
            name + ": controls out of range 0.." + std::to_string(control_count - 1));
    const auto linear = storage.frame.topLeftCorner<3, 3>();
    require(storage.frame.allFinite() && std::abs(linear.determinant()) > 0 && linear.inverse().allFinite() &&
                storage.frame.row(3) == Eigen::RowVector4d(0, 0, 0, 1),
            name + ": the matrix is not affine and invertible; an object of zero scale cannot be edited");
  }
}

std::size_t count_different(const IndexPairs& pairs) {
  std::set<Index> firsts;
  for (const auto& pair : pairs) firsts.insert(pair.first);
  return firsts.size();
}

/// "3 pairs of faces cut each other, and 1 loose edge or vertex cuts a face"; leaves out what does not occur.
std::string counts(const StaticPairs& found) {
  const std::size_t faces = found.faces.size();
  const std::size_t loose = count_different(found.loose_edges) + count_different(found.loose_vertices);
  std::string text;
  if (faces > 0) text = (faces == 1 ? "1 pair" : std::to_string(faces) + " pairs") + " of faces cut each other";
  if (faces > 0 && loose > 0) text += ", and ";
  if (loose == 1) text += "1 loose edge or vertex cuts a face";
  if (loose > 1) text += std::to_string(loose) + " loose edges or vertices cut faces";
  return text;
}

}  // namespace

void check_fit(const Surface& surface, const Deformation& deformation, Index obstacle_vertices) {
  require(surface.vertex_count() == deformation.vertex_count() + obstacle_vertices,
          "the deformation gives " + std::to_string(deformation.vertex_count()) + " vertices, the surface has " +
              std::to_string(surface.vertex_count()));
}

void check_options(const EditOptions& options, Index control_count) {
  require(options.min_clearance_ratio > 0 && options.min_clearance_ratio < 1,
          "min_clearance_ratio must lie between 0 and 1");
  require(options.min_clearance_ratio_between > 0 && options.min_clearance_ratio_between < 1,
          "min_clearance_ratio_between must lie between 0 and 1");
  require(std::isfinite(options.smoothness) && options.smoothness > 0, "smoothness must be positive");
  require(options.max_sub_edits >= 1 && options.max_rounds >= 1 && options.accumulated_rounds >= 0,
          "max_sub_edits and max_rounds must be at least 1, accumulated_rounds at least 0");
  require(std::isfinite(options.pull_limit) && options.pull_limit >= 0, "pull_limit must not be negative");
  require(std::isfinite(options.time_budget) && options.time_budget >= 0, "time_budget must not be negative");
  check_weights(options.weights, control_count);
  check_storage(options.storage, control_count);
}

void check_overlapping(const Surface& surface, const std::vector<std::pair<Index, Index>>& overlapping) {
  const auto count = static_cast<Index>(surface.bodies().size());
  for (const auto& [a, b] : overlapping)
    require(std::min(a, b) >= 0 && std::max(a, b) < count && a != b, "overlapping: (" + std::to_string(a) + ", " +
                                                                         std::to_string(b) + ") is not a pair of the " +
                                                                         std::to_string(count) + " bodies");
}

void check_touching(const Surface& surface, const std::vector<Index>& touching) {
  const auto count = static_cast<Index>(surface.bodies().size());
  for (const Index body : touching)
    require(body >= 0 && body < count,
            "touching: " + std::to_string(body) + " is not one of the " + std::to_string(count) + " bodies");
}

std::string describe_control(const Surface& surface, const Deformation& deformation, Index control) {
  const std::vector<Index> support = deformation.support(control);
  std::string name = "control " + std::to_string(control);
  if (support.empty()) return name;
  return "object \"" + surface.bodies()[surface.body_of(support.front())].name + "\", " + name;
}

std::string describe(const Surface& surface, const StaticPairs& found,
                     const std::function<std::string(Index)>& name_face) {
  std::ostringstream message;
  message << "the start already intersects: " << counts(found);
  const auto name_first = [&](const IndexPairs& pairs, const auto& describe_first) {
    for (std::size_t k = 0; k < std::min(pairs.size(), pairs_named); ++k)
      message << "; " << describe_first(pairs[k].first) << " with " << name_face(pairs[k].second);
  };
  name_first(found.faces, name_face);
  name_first(found.loose_edges,
             [&](Index edge) { return surface.describe_vertex(surface.loose_edges()(edge, 0)) + " (loose edge)"; });
  name_first(found.loose_vertices, [&](Index vertex) { return surface.describe_vertex(vertex) + " (loose)"; });
  message << ". Move them apart, repair them, or exclude these pairs of objects";
  return message.str();
}

std::string describe(const Surface& surface, const StaticPairs& found) {
  return describe(surface, found, [&](Index face) { return surface.describe_triangle(face); });
}

}  // namespace stiv
