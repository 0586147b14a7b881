// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/pair_test.hpp"

#include <algorithm>

#include "detection/plane_filter.hpp"
#include "stiv/error.hpp"

namespace stiv {

namespace {

PairMotion motion_of(const Step& step, const std::array<Index, 4>& v) {
  PairMotion motion;
  for (std::size_t k = 0; k < 4; ++k) {
    motion.start[k] = step.start.row(v[k]);
    motion.end[k] = step.end.row(v[k]);
  }
  return motion;
}

}  // namespace

std::vector<unsigned char> moved_vertices(const Step& step) {
  std::vector<unsigned char> moved(static_cast<std::size_t>(step.start.rows()));
  for (Index vertex = 0; vertex < step.start.rows(); ++vertex)
    moved[static_cast<std::size_t>(vertex)] = (step.start.row(vertex).array() != step.end.row(vertex).array()).any();
  return moved;
}

PairTest::PairTest(const Surface& surface, const Step& step, NarrowPhase narrow_phase)
    : surface_(surface), step_(step), narrow_phase_(narrow_phase), moved_(moved_vertices(step)) {}

PairTest::Vertices PairTest::vertices(EventKind kind, const Candidate& candidate) const {
  if (kind == EventKind::vertex_face) {
    const auto face = surface_.triangles().row(candidate.second);
    return {candidate.first, face[0], face[1], face[2]};
  }
  const auto a = surface_.edges().row(std::min(candidate.first, candidate.second));
  const auto b = surface_.edges().row(std::max(candidate.first, candidate.second));
  return {a[0], a[1], b[0], b[1]};
}

bool PairTest::matters(EventKind kind, const Vertices& v) const {
  const bool apart = kind == EventKind::vertex_face ? (v[0] != v[1]) & (v[0] != v[2]) & (v[0] != v[3])
                                                    : (v[0] != v[2]) & (v[0] != v[3]) & (v[1] != v[2]) & (v[1] != v[3]);
  const auto moved = [&](std::size_t k) { return moved_[static_cast<std::size_t>(v[k])]; };
  return apart & ((moved(0) | moved(1) | moved(2) | moved(3)) != 0) &
         surface_.bodies_meet(surface_.body_of(v[0]), surface_.body_of(v[3])) & !surface_.in_one_recut_face(v);
}

// Places are written without branches; only the count tells which of them stay.
std::span<Candidate> PairTest::that_matter(EventKind kind, std::span<Candidate> candidates) const {
  std::size_t count = 0;
  for (const Candidate candidate : candidates) {
    candidates[count] = candidate;
    count += matters(kind, vertices(kind, candidate));
  }
  return candidates.first(count);
}

std::span<Candidate> PairTest::reduce(EventKind kind, std::span<Candidate> candidates) const {
  candidates = that_matter(kind, candidates);
  PlaneFilter filter;
  std::size_t count = 0;
  for (std::size_t begin = 0; begin < candidates.size(); begin += PlaneFilter::width) {
    const std::size_t lanes = std::min(PlaneFilter::width, candidates.size() - begin);
    for (std::size_t lane = 0; lane < lanes; ++lane)
      filter.set(lane, vertices(kind, candidates[begin + lane]), step_.start, step_.end);
    const auto apart = filter.apart(kind, step_.proximity.separation);
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      candidates[count] = candidates[begin + lane];
      count += apart[lane] == 0;
    }
  }
  return candidates.first(count);
}

std::optional<Contact> PairTest::contact_of(EventKind kind, const PairMotion& motion, double latest) const {
  switch (narrow_phase_) {
    case NarrowPhase::conservative:
      return first_contact(kind, motion, step_.proximity, latest);
  }
  throw InputError("there is no such narrow phase");
}

std::optional<Event> PairTest::event(EventKind kind, const Candidate& candidate, double latest) const {
  const Vertices v = vertices(kind, candidate);
  const std::optional<Contact> contact = contact_of(kind, motion_of(step_, v), latest);
  if (!contact) return std::nullopt;
  return Event{kind, v, contact->time, contact->weights, contact->normal, contact->start_distance};
}

}  // namespace stiv
