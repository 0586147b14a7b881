// SPDX-License-Identifier: GPL-3.0-or-later
// Consecutive steps of a small mesh: a detector with cached trees and candidates finds exactly the events of brute
// force, with every broad phase; the earliest time is their minimum.
#include <algorithm>

#include "small_mesh.hpp"
#include "stiv/detection/detector.hpp"

using namespace stiv;

namespace {

bool same(const Event& a, const Event& b) {
  return a.kind == b.kind && a.vertices == b.vertices && a.time == b.time && a.weights == b.weights &&
         a.normal == b.normal && a.start_distance == b.start_distance;
}

bool same(const Events& a, const Events& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Event& x, const Event& y) { return same(x, y); });
}

double earliest(const Events& events) {
  double time = never;
  for (const Event& event : events) time = std::min(time, event.time);
  return time;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Input input(data, size);
  const auto surface = fuzz::small_surface(input);
  const bool on_grid = input.below(2) == 0;
  constexpr double separations[] = {0, 0x1p-10, 0.0625, 0.5};
  const Proximity proximity{separations[input.below(4)], 0.5};
  const NarrowPhase narrow = input.below(4) == 0 ? NarrowPhase::polynomial : NarrowPhase::conservative;
  Detector tree(surface, {BroadPhase::bvh, narrow}), grid(surface, {BroadPhase::hash_grid, narrow});
  Positions start = input.positions(surface->vertex_count(), on_grid);
  for (int round = 0; round < 4 && !input.empty(); ++round) {
    Positions end = start;
    for (Index vertex = 0; vertex < end.rows(); ++vertex)
      if (input.below(3) != 0) end.row(vertex) += 0.25 * input.point(on_grid).transpose();
    Detector fresh(surface, {BroadPhase::brute_force, narrow});
    Execution execution(1), two_threads(2);
    const Events expected = fresh.find(start, end, proximity, execution);
    fuzz::require(same(grid.find(start, end, proximity, execution), expected), "the hash grid equals brute force");
    fuzz::require(same(tree.find(start, end, proximity, execution), expected), "the trees equal brute force");
    fuzz::require(tree.earliest_time(start, end, proximity, execution) == earliest(expected),
                  "the earliest time is that of the earliest event");
    if (input.below(16) == 0)
      fuzz::require(same(tree.find(start, end, proximity, two_threads), expected), "two threads equal one");
    if (input.below(2) == 0) start = end;
  }
  return 0;
}
