// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "detection/broad_phase/step.hpp"
#include "detection/broad_phase/vertex_steps.hpp"
#include "detection/primitive_pair.hpp"
#include "stiv/detection/detector.hpp"
#include "stiv/detection/event.hpp"
#include "stiv/execution.hpp"
#include "stiv/surface.hpp"

namespace stiv {

/// Two primitives that may interfere. VF: vertex and triangle; EE: two edges.
using Candidate = PrimitivePair;

/// A broad phase: provides candidates in chunks, which threads share. Chunks and the candidates of a chunk do not
/// depend on the number of threads. Candidates are relevant (see Relevance) and unique. Pairs whose padded bounds stay
/// apart (see SweptVertices) may be skipped.
class CandidateSource {
 public:
  /// Takes some candidates of a chunk, and may overwrite them.
  using Sink = std::function<void(std::span<Candidate>)>;

  virtual ~CandidateSource() = default;
  /// Does the part of the first update that depends on its start alone, given a step that ends there. With resting
  /// vertices, that includes all boxes.
  virtual void prepare(const Step&, const Execution&) {}
  /// Promises that the last vertices, this many, have the same positions in all steps.
  virtual void set_resting(Index) {}
  /// @throws InputError as Surface::check_positions, except for the shape
  virtual void update(const Step& step, const Execution& execution) = 0;
  /// Takes a short step from or to the surface of the last update if the candidates then contain every pair that
  /// touches in it. Otherwise returns false, with nothing changed.
  virtual bool take_short_step(const PositionsView&, const PositionsView&, const Execution&) { return false; }
  /// The step that was taken last, for vector code to load.
  virtual const VertexSteps& vertex_steps() const = 0;
  /// Are the candidates few enough for bounded time and memory? Depends only on the step. Visits are complete in any
  /// case.
  virtual bool is_within_pair_limit() const { return true; }
  virtual Index chunk_count(EventKind kind) const = 0;
  virtual void visit(EventKind kind, Index chunk, const Sink& sink) const = 0;
};

std::unique_ptr<CandidateSource> make_brute_force(const Surface& surface);
std::unique_ptr<CandidateSource> make_bvh_source(const Surface& surface);
std::unique_ptr<CandidateSource> make_hash_grid(const Surface& surface);

/// The source of a broad phase over a surface, which must outlive it.
std::unique_ptr<CandidateSource> make_source(BroadPhase broad_phase, const Surface& surface);

}  // namespace stiv
