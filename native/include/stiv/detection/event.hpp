// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "stiv/detection/proximity.hpp"
#include "stiv/types.hpp"

namespace stiv {

enum class EventKind : std::uint8_t {
  vertex_face,  ///< vertices: v, a, b, c
  edge_edge     ///< vertices: a0, a1 of one edge, b0, b1 of the other
};

/// Two primitives that reach the separation at `time` in [0, 1] of a step. [P3.1; mathematics.md,
/// "Continuous detection"]
/// With the weights w: sum_k w_k = 0 and sum_k w_k x_k(time) is the separation vector, from second to first side.
struct Event {
  EventKind kind = EventKind::vertex_face;
  bool is_plane = false;  ///< the normal is that of a plane between two faces, also where corners meet
  std::array<Index, 4> vertices{};
  double time = 0;
  std::array<double, 4> weights{};   ///< VF (1, -a, -b, -c); EE (1-s, s, -(1-u), -u)
  Vector3 normal = Vector3::Zero();  ///< unit; normal . (relative displacement) <= 0; zero if it is undetermined
  double start_distance = 0;         ///< at the start of the step
  PairClearance clearance;           ///< of the pair
};

using Events = std::vector<Event>;

inline constexpr double never = std::numeric_limits<double>::infinity();

/// Number of leading vertices that form the first side: 1 for VF, 2 for EE.
inline constexpr int first_side_size(EventKind kind) { return kind == EventKind::vertex_face ? 1 : 2; }

/// sum_k w_k d_k of the event's four vertices in a field `d` over the surface, (N, 3).
template <class Field>
Vector3 weighted_sum(const Event& event, const Field& d) {
  Vector3 sum = Vector3::Zero();
  for (int k = 0; k < 4; ++k) sum += event.weights[k] * d.row(event.vertices[k]).transpose();
  return sum;
}

}  // namespace stiv
