// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/pair_test.hpp"

#include <algorithm>

#include "detection/relative_motion.hpp"
#include "stiv/detection/narrow_phase.hpp"

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

PairTest::PairTest(const Surface& surface, const Step& step)
    : surface_(surface), step_(step), moved_(moved_vertices(step)) {}

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
  return apart && (moved(0) | moved(1) | moved(2) | moved(3)) != 0 &&
         surface_.bodies_meet(surface_.body_of(v[0]), surface_.body_of(v[3]));
}

bool PairTest::plane_separates(EventKind kind, const Vertices& v) const {
  const RelativeMotion motion(kind, motion_of(step_, v));
  const double clearance = step_.proximity.separation + motion.rounding;
  const Vector3 normal = geometric_normal(motion, 0);
  return reach_of_plane(motion, normal, 0, clearance) >= 1 || reach_of_plane(motion, -normal, 0, clearance) >= 1;
}

std::span<Candidate> PairTest::reduce(EventKind kind, std::span<Candidate> candidates) const {
  const auto settled = [&](const Candidate& candidate) {
    const Vertices v = vertices(kind, candidate);
    return !matters(kind, v) || plane_separates(kind, v);
  };
  const auto end = std::remove_if(candidates.begin(), candidates.end(), settled);
  return candidates.first(static_cast<std::size_t>(end - candidates.begin()));
}

std::optional<Event> PairTest::event(EventKind kind, const Candidate& candidate, double latest) const {
  const Vertices v = vertices(kind, candidate);
  const std::optional<Contact> contact = first_contact(kind, motion_of(step_, v), step_.proximity, latest);
  if (!contact) return std::nullopt;
  return Event{kind, v, contact->time, contact->weights, contact->normal, contact->start_distance};
}

}  // namespace stiv
