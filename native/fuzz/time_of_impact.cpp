// SPDX-License-Identifier: GPL-3.0-or-later
// One pair of primitives: the time of impact is never later than a contact found by an independent search, for any
// order of the vertices.
#include <algorithm>
#include <initializer_list>

#include "detection/reference.hpp"
#include "input.hpp"
#include "stiv/execution.hpp"

using namespace stiv;

namespace {

constexpr double separations[] = {0, 0x1p-20, 0x1p-6, 0.125, 1};

PairMotion reordered(const PairMotion& motion, const std::array<std::size_t, 4>& order) {
  PairMotion other;
  for (std::size_t k = 0; k < 4; ++k) {
    other.start[k] = motion.start[order[k]];
    other.end[k] = motion.end[order[k]];
  }
  return other;
}

double magnitude(const PairMotion& motion) {
  double largest = 0;
  for (std::size_t k = 0; k < 4; ++k)
    largest = std::max({largest, motion.start[k].cwiseAbs().maxCoeff(), motion.end[k].cwiseAbs().maxCoeff()});
  return largest;
}

std::initializer_list<std::array<std::size_t, 4>> orders(EventKind kind) {
  static const std::initializer_list<std::array<std::size_t, 4>> face{{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 2, 1}};
  static const std::initializer_list<std::array<std::size_t, 4>> edges{{0, 1, 2, 3}, {2, 3, 0, 1}, {1, 0, 2, 3}};
  return kind == EventKind::vertex_face ? face : edges;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Input input(data, size);
  const FloatingPointScope floating_point;
  const EventKind kind = input.below(2) == 0 ? EventKind::vertex_face : EventKind::edge_edge;
  const double scale = std::exp2(8 * (input.below(7) - 3));
  const double separation = scale * separations[input.below(5)];
  const bool on_grid = input.below(2) == 0, flat = input.below(4) == 0;
  PairMotion motion;
  for (std::size_t k = 0; k < 4; ++k) {
    motion.start[k] = scale * input.point(on_grid);
    motion.end[k] = scale * input.point(on_grid);
    if (flat) motion.start[k][2] = motion.end[k][2] = 0;
  }
  // The search finds contacts up to the rounding of extended arithmetic, which is too small to distinguish points
  // of the grid.
  const double certain = separation * (1 - 1e-9) - (on_grid ? 0 : 0x1p-54 * magnitude(motion));
  const reference::Answer answer = reference::first_time(kind, motion, certain, 0x1p-7L);
  for (const auto& order : orders(kind)) {
    const PairMotion same = reordered(motion, order);
    const double time = time_of_impact(kind, same, separation);
    fuzz::require((time >= 0 && time <= 1) || time == never, "a time in [0, 1], or never");
    fuzz::require(!(answer.time < time), "no contact before the time of impact");
    const std::optional<Contact> contact = first_contact(kind, same, {separation, 0.5});
    if (!contact) continue;
    double sum = 0;
    for (const double weight : contact->weights) sum += weight;
    fuzz::require(contact->time >= 0 && contact->time <= 1, "the contact is within the step");
    fuzz::require(std::abs(sum) <= 1e-12, "weights of a contact sum to zero");
    fuzz::require(contact->normal.isZero() || std::abs(contact->normal.norm() - 1) <= 1e-9, "the normal is unit");
  }
  return 0;
}
