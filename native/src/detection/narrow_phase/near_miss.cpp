// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/narrow_phase/near_miss.hpp"

#include <array>
#include <cmath>
#include <optional>
#include <tuple>

namespace stiv {

namespace {

using Vector = VectorOf<DoubleDouble>;

/// Numbers of vertices of a pair.
struct VertexAndEdge {
  std::size_t vertex = 0, first = 0, second = 0;
};

/// The vertices of a side that carry a nearest point.
struct Carriers {
  std::array<std::size_t, 4> vertices{};
  std::size_t count = 0;
};

Carriers carriers(const std::array<double, 4>& weights, std::size_t begin, std::size_t end) {
  constexpr double noise = 0x1p-20;
  Carriers result;
  for (std::size_t k = begin; k < end; ++k)
    if (std::abs(weights[k]) > noise) result.vertices[result.count++] = k;
  return result;
}

/// If one nearest point is a vertex up to rounding, and the other one lies within an edge.
std::optional<VertexAndEdge> nearest_vertex_and_edge(EventKind kind, const std::array<double, 4>& weights) {
  const auto size = static_cast<std::size_t>(first_side_size(kind));
  const Carriers first = carriers(weights, 0, size), second = carriers(weights, size, 4);
  if (first.count + second.count != 3) return std::nullopt;
  const auto& [vertex, edge] = first.count == 1 ? std::tie(first, second) : std::tie(second, first);
  if (vertex.count != 1) return std::nullopt;
  return VertexAndEdge{vertex.vertices[0], edge.vertices[0], edge.vertices[1]};
}

/// About as long as one, orthogonal to the edge and to the vertex' motion relative to the nearest point of the edge.
std::optional<Vector> normal_of_passage(const RelativeMotion<DoubleDouble>& motion, const VertexAndEdge& near,
                                        const Approach<double>& approach) {
  const auto& weights = approach.witness.weights;
  const double w = weights[near.second] / (weights[near.first] + weights[near.second]);
  // If the edge does not turn, its part is exactly zero, whatever the rounding of the weight.
  const Vector turn = motion.step[near.second] - motion.step[near.first];
  const Vector edge = motion.start[near.second] - motion.start[near.first] + DoubleDouble(approach.time) * turn;
  const Vector passage = motion.step[near.vertex] - motion.step[near.first] - DoubleDouble(w) * turn;
  const Vector normal = edge.cross(passage);
  const double length = Vector3(normal[0].high, normal[1].high, normal[2].high).norm();
  if (!(length > 0) || !std::isfinite(1 / length)) return std::nullopt;
  return Vector(DoubleDouble(1 / length) * normal);
}

}  // namespace

bool slips_past(const RelativeMotion<DoubleDouble>& motion, double threshold, const Approach<double>& approach) {
  const std::optional<VertexAndEdge> near = nearest_vertex_and_edge(motion.kind, approach.witness.weights);
  if (!near) return false;
  const std::optional<Vector> normal = normal_of_passage(motion, *near, approach);
  if (!normal) return false;
  // Beyond all that an advancement would report, and beyond the error of the normal's length.
  const DoubleDouble clearance = DoubleDouble(threshold * (1 + 0x1p-8)) + 16 * motion.rounding;
  const DoubleDouble time = approach.time;
  return reach_of_plane(motion, *normal, time, clearance) >= 1 ||
         reach_of_plane<DoubleDouble>(motion, -*normal, time, clearance) >= 1;
}

}  // namespace stiv
