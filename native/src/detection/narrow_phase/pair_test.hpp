// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "detection/broad_phase/candidate_source.hpp"
#include "detection/filters/pair_filters.hpp"
#include "stiv/detection/detector.hpp"
#include "stiv/detection/narrow_phase.hpp"

namespace stiv {

/// Tests candidates of any broad phase: filters remove pairs that a fixed plane separates, and the narrow phase decides
/// the rest.
class PairTest {
 public:
  /// @param vertices the step: of all vertices, or of those of all candidates
  PairTest(const Surface& surface, const VertexSteps& vertices, const Proximity& proximity, NarrowPhase narrow_phase);

  /// Moves the candidates that need the narrow phase to the front and returns them.
  std::span<Candidate> reduce(EventKind kind, std::span<Candidate> candidates) const;

  /// The event of a pair up to time `latest`.
  std::optional<Event> event(EventKind kind, const Candidate& candidate, double latest) const;

 private:
  template <class Find>
  std::span<Candidate> without(EventKind kind, std::span<Candidate> candidates, double separation,
                               const Find& find) const;
  std::optional<Contact> contact_of(EventKind kind, const PairMotion& motion, Proximity proximity, double latest) const;

  const Surface& surface_;
  const VertexSteps& vertices_;
  const Proximity& proximity_;
  NarrowPhase narrow_phase_;
};

}  // namespace stiv
