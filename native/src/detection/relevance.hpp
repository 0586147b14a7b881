// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <span>
#include <vector>

#include "detection/candidates.hpp"

namespace stiv {

/// The vertices of a candidate in the order of Event::vertices; of two edges, the one with the lower number first.
std::array<Index, 4> vertices_of(const Surface& surface, EventKind kind, const Candidate& candidate);

/// Which pairs of primitives can interfere at all during a step: those that share no vertex, of which a vertex moves,
/// and whose bodies meet.
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
