// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "penetration/body_penetrations.hpp"
#include "stiv/acceptance/intersections.hpp"

namespace stiv {

/// Watches pairs of bodies that may overlap, but no more than at the start of the session: their common volume, the
/// area of an open component inside a closed one, or, of two open components, the length of the curve in which they
/// intersect. That length may grow while the volume common to the boxes of both bodies does not. Only these bodies are
/// measured, whatever the rest of the scene. (mathematics.md, "Overlapping bodies")
class OverlapWatch {
 public:
  /// @param rounding largest displacement of a vertex by storage
  OverlapWatch(const Surface& surface, const BodyPairs& pairs, double rounding);

  /// The pairs of bodies of the surface that meet, each once.
  const BodyPairs& pairs() const { return pairs_; }
  bool begun() const { return penetrations_.has_value(); }

  /// Measures the start, (N, 3).
  void begin(const Positions& q, Execution& execution);
  /// Marks the pairs that overlap at q, (N, 3).
  const std::vector<unsigned char>& overlapping(const Positions& q, Execution& execution);
  /// True if any pair overlaps more than at the start, beyond rounding.
  bool is_deeper(const Positions& q, Execution& execution);

  /// The largest fraction of a linear step, given that its start is accepted, up to which no pair that overlaps at the
  /// start of the step was found deeper. It ends where a pair comes apart: from there on, the pair is guarded. The
  /// step is sampled, each sample a fraction of the depth.
  double free_fraction(const Positions& from, const Positions& to, Execution& execution);

 private:
  /// A pair of bodies, and how far these may move against each other between two samples.
  struct Watched {
    Index first = 0, second = 0;
    double stride = 0, common_box = 0;
  };
  struct State {
    Positions q;  ///< of the watched vertices
    std::vector<Penetration> penetrations;
    std::vector<unsigned char> overlapping;
  };

  Positions watched_rows(const Positions& q) const;
  const State& measure(Positions q, Execution& execution);
  const State& measure_accepted(Positions q, Execution& execution);
  void mark_overlapping(State& state, const IndexPairs& intersecting) const;
  bool is_deeper(const State& state) const;
  std::size_t pair_of(const std::array<Index, 2>& bodies) const;
  double stride_of(std::size_t pair, const State& start) const;
  double relative_displacement(const Watched& pair, const Positions& from, const Positions& to) const;
  Eigen::AlignedBox3d box_of(Index body, const Positions& q) const;
  double common_box(const Watched& pair, const Positions& q) const;

  BodyPairs pairs_;
  double rounding_;
  std::vector<Index> vertices_;  ///< of the surface, of watched bodies
  std::shared_ptr<const Surface> bodies_;
  std::vector<std::vector<Index>> vertices_of_;  ///< of each watched body
  std::vector<Watched> watched_;                 ///< like `pairs_`, as bodies of `bodies_`
  std::optional<IntersectionTest> test_;
  std::optional<BodyPenetrations> penetrations_;
  std::vector<BodyPenetrations::Pair> measured_;
  State start_, last_;
  State accepted_;  ///< the start of the last step: a search for the largest free step tries many from there
};

}  // namespace stiv
