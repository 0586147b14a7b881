// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "detection/broad_phase/candidate_source.hpp"

namespace stiv {

/// The vertices of a candidate in the order of Event::vertices; of two edges, the one with the lower index first.
/// Inline: called once per candidate.
inline std::array<Index, 4> vertices_of(const Surface& surface, EventKind kind, const Candidate& candidate) {
  if (kind == EventKind::vertex_face) {
    const Index* const face = surface.triangles().data() + 3 * static_cast<std::ptrdiff_t>(candidate.second);
    return {candidate.first, face[0], face[1], face[2]};
  }
  const Index* const edges = surface.edges().data();
  const Index* const a = edges + 2 * static_cast<std::ptrdiff_t>(std::min(candidate.first, candidate.second));
  const Index* const b = edges + 2 * static_cast<std::ptrdiff_t>(std::max(candidate.first, candidate.second));
  return {a[0], a[1], b[0], b[1]};
}

/// Selects the pairs that can interfere in a step: they share no vertex, one of their vertices moves, and their bodies
/// are tested against each other.
class Relevance {
 public:
  Relevance(const Surface& surface, const Step& step);

  /// Moves the relevant candidates to the front and returns them.
  std::span<Candidate> select(EventKind kind, std::span<Candidate> candidates) const;

 private:
  bool relevant(EventKind kind, const std::array<Index, 4>& v) const;

  const Surface& surface_;
  std::vector<unsigned char> moved_;
};

}  // namespace stiv
