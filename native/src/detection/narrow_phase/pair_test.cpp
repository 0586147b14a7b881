// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/narrow_phase/pair_test.hpp"

#include <algorithm>

#include "detection/broad_phase/relevance.hpp"
#include "detection/filters/pair_filters.hpp"
#include "stiv/error.hpp"

namespace stiv {

namespace {

/// Relative to the separation: an advancement may end a thousandth before it.
constexpr double furthest_reported = 1 + 0x1p-9;

PairMotion motion_of(const VertexStep* vertices, const Positions* reference, const std::array<Index, 4>& v) {
  PairMotion motion;
  for (std::size_t k = 0; k < 4; ++k) {
    motion.start[k] = Eigen::Map<const Vector3>(vertices[v[k]].start);
    motion.end[k] = Eigen::Map<const Vector3>(vertices[v[k]].end);
  }
  if (reference == nullptr) return motion;
  motion.reference.emplace();
  for (std::size_t k = 0; k < 4; ++k) (*motion.reference)[k] = reference->row(v[k]);
  return motion;
}

}  // namespace

PairTest::PairTest(const Surface& surface, const VertexSteps& vertices, const Proximity& proximity,
                   NarrowPhase narrow_phase)
    : surface_(surface), vertices_(vertices), proximity_(proximity), narrow_phase_(narrow_phase) {}

/// Moves the candidates to the front that `find(kind, block, vertices, separation, flags)` does not flag, and returns
/// them.
template <class Find>
std::span<Candidate> PairTest::without(EventKind kind, std::span<Candidate> candidates, double separation,
                                       const Find& find) const {
  PairBlock block;
  PairFlags apart;
  std::size_t kept = 0;
  for (std::size_t begin = 0; begin < candidates.size(); begin += block.count) {
    block.count = 0;
    const std::span<Candidate> some =
        candidates.subspan(begin, std::min(PairBlock::capacity, candidates.size() - begin));
    for (const Candidate& candidate : some) block.add(vertices_of(surface_, kind, candidate));
    find(kind, block, vertices_, separation, apart);
    for (std::size_t k = 0; k < some.size(); ++k) {
      candidates[kept] = some[k];
      kept += apart[k] == 0;
    }
  }
  return candidates.first(kept);
}

std::span<Candidate> PairTest::reduce(EventKind kind, std::span<Candidate> candidates) const {
  const double separation = proximity_.separation;
  const std::span<Candidate> left = without(kind, candidates, separation, find_apart_by_planes);
  return without(kind, left, furthest_reported * separation, find_apart_by_closest_points);
}

std::optional<Contact> PairTest::contact_of(EventKind kind, const PairMotion& motion, Proximity proximity,
                                            double latest) const {
  switch (narrow_phase_) {
    case NarrowPhase::conservative:
      return first_contact(kind, motion, proximity, latest);
    case NarrowPhase::polynomial:
      return first_contact_by_polynomial(kind, motion, proximity, latest);
  }
  throw InputError("there is no such narrow phase");
}

std::optional<Event> PairTest::event(EventKind kind, const Candidate& candidate, double latest) const {
  const std::array<Index, 4> v = vertices_of(surface_, kind, candidate);
  const Proximity proximity = proximity_.between(surface_.body_of(v[0]), surface_.body_of(v[3]));
  const PairMotion motion = motion_of(vertices_.data(), proximity.reference, v);
  const std::optional<Contact> contact = contact_of(kind, motion, proximity, latest);
  if (!contact) return std::nullopt;
  return Event{
      kind, false, v, contact->time, contact->weights, contact->normal, contact->start_distance, contact->clearance};
}

}  // namespace stiv
