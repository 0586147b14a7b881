// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/broad_phase/relevance.hpp"

namespace stiv {

Relevance::Relevance(const Surface& surface, const Step& step)
    : surface_(surface), moved_(static_cast<std::size_t>(step.start.rows())) {
  for (Index vertex = 0; vertex < step.start.rows(); ++vertex)
    moved_[vertex] = (step.start.row(vertex).array() != step.end.row(vertex).array()).any();
}

bool Relevance::relevant(EventKind kind, const std::array<Index, 4>& v) const {
  const bool apart = kind == EventKind::vertex_face ? (v[0] != v[1]) & (v[0] != v[2]) & (v[0] != v[3])
                                                    : (v[0] != v[2]) & (v[0] != v[3]) & (v[1] != v[2]) & (v[1] != v[3]);
  const auto moved = [&](std::size_t k) { return moved_[v[k]]; };
  return apart & ((moved(0) | moved(1) | moved(2) | moved(3)) != 0) &
         surface_.bodies_meet(surface_.body_of(v[0]), surface_.body_of(v[3])) & !surface_.in_one_flip_face(v);
}

// Without branches: each candidate is written, and the count decides whether it stays.
std::span<Candidate> Relevance::select(EventKind kind, std::span<Candidate> candidates) const {
  std::size_t count = 0;
  for (const Candidate candidate : candidates) {
    candidates[count] = candidate;
    count += relevant(kind, vertices_of(surface_, kind, candidate));
  }
  return candidates.first(count);
}

}  // namespace stiv
