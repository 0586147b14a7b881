// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "detection/broad_phase/candidate_source.hpp"
#include "detection/narrow_phase/pair_test.hpp"
#include "stiv/detection/detector.hpp"

namespace stiv {

/// Candidates of each kind, by EventKind.
using ClosePairs = std::array<std::vector<Candidate>, 2>;

/// Whether a search may refuse a step: one that has too many candidates for bounded time and memory, or one with events
/// in which a large body moves by many edges. Too long a step between contacts leads to poor constraints.
enum class PairLimit { respected, ignored };

/// Broad phase, filters and narrow phase over all pairs of a surface. The implementation of Detector.
class PairSearch {
 public:
  PairSearch(std::shared_ptr<const Surface> surface, DetectorOptions options);

  /// As CandidateSource.
  void prepare(const Step& still, const Execution& execution) { source_->prepare(in_frames(still), execution); }

  /// As CandidateSource.
  void set_resting(Index count) { source_->set_resting(count); }

  /// Nothing if a step is refused.
  /// @throws InputError for a step or a proximity that does not fit, as the others
  std::optional<Events> find(const Step& given, PairLimit limit, Execution& execution);
  std::optional<double> earliest_time(const Step& given, PairLimit limit, Execution& execution);

  /// Earliest contact in a short step, decided by the candidates of the last search. Nothing, with nothing changed, if
  /// these may miss a pair that touches: then search. Close pairs are afterwards those of a search of this step.
  /// @param step its proximity must ask no pair of bodies to keep a distance
  std::optional<double> earliest_contact(const Step& step, Execution& execution);

  /// Moves out the pairs that the step of the last complete search may bring close (see append_close); none if they
  /// were taken before.
  ClosePairs take_close_pairs(const Execution& execution);
  bool has_close_pairs() const { return last_.has_value() || unsearched_.has_value(); }
  void drop_close_pairs() {
    last_.reset();
    unsearched_.reset();
  }

  /// Events of a step among some pairs; `steps` holds the step of their vertices.
  Events find_among(const ClosePairs& pairs, const VertexSteps& steps, const Proximity& proximity,
                    Execution& execution) const;

  void check_step(const Step& step) const;
  FrameMotions frame_motions(const PositionsView& start, const PositionsView& end) const {
    return frames_.choose(start, end);
  }
  const Surface& surface() const { return *surface_; }

 private:
  /// Result of one chunk.
  struct ChunkResult {
    Events events;
    std::int64_t candidates = 0;
    std::int64_t tested = 0;
  };
  /// Parameters of a complete search, from which its close pairs are computed.
  struct WholeSearch {
    FrameMotions motions;
    double separation = 0;
  };

  /// A step after its check, with the frames of its bodies.
  Step in_frames(const Step& step) const;
  template <class Decide>
  std::optional<std::vector<ChunkResult>> search(const Step& step, PairLimit limit, Execution& execution,
                                                 const Decide& decide);
  template <class Decide>
  std::vector<ChunkResult> decide_candidates(const Proximity& proximity, Execution& execution,
                                             const Decide& decide) const;
  void search_again(const Execution& execution);
  template <class Decide>
  static void decide_all(const PairTest& test, EventKind kind, std::span<Candidate> candidates, const Decide& decide,
                         ChunkResult& result);
  static Events collect(const std::vector<ChunkResult>& results, Execution& execution);
  static void count(const std::vector<ChunkResult>& results, Counters& counters);

  std::shared_ptr<const Surface> surface_;
  NarrowPhase narrow_phase_;
  FrameChooser frames_;
  std::unique_ptr<CandidateSource> source_;
  std::optional<WholeSearch> last_;   ///< set while the close pairs of a complete search can be taken
  std::optional<double> unsearched_;  ///< separation of the step of `source_`, if close pairs need a search of it
};

/// @throws InputError for a separation or a clearance ratio out of range
void check_proximity(const Proximity& proximity);

}  // namespace stiv
