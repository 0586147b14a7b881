// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/close_pairs.hpp"

#include <algorithm>

#include "detection/broad_phase/relevance.hpp"
#include "detection/filters/pair_filters.hpp"

namespace stiv {

namespace {

/// Candidates and their vertices, side by side.
struct CandidateBlock {
  PairBlock pairs;
  std::array<Candidate, PairBlock::capacity> candidates;

  void add(const Candidate& candidate, const std::array<Index, 4>& vertices) {
    candidates[pairs.count] = candidate;
    pairs.add(vertices);
  }
};

}  // namespace

void append_close(const Surface& surface, EventKind kind, std::span<const Candidate> candidates,
                  const VertexSteps& vertices, const FrameMotions& motions, double separation,
                  std::vector<Candidate>& close) {
  // A broad phase may skip pairs whose boxes are apart, depending on its frame. The result must not depend on it.
  const double box_separation = 1.1 * separation;
  // This bound on rounding is tighter than that of any source, so no source can have skipped a close pair.
  NearbySteps same_step{Vector3::Zero(), separation, 0, 0x1p-44};
  CandidateBlock all, near;
  PairFlags apart;
  const auto append_near = [&] {
    find_apart_by_hulls(kind, near.pairs, vertices, same_step, apart);
    for (std::size_t k = 0; k < near.pairs.count; ++k)
      if (apart[k] == 0) close.push_back(near.candidates[k]);
    near.pairs.count = 0;
  };
  for (std::size_t begin = 0; begin < candidates.size(); begin += PairBlock::capacity) {
    all.pairs.count = 0;
    for (const Candidate& candidate :
         candidates.subspan(begin, std::min(PairBlock::capacity, candidates.size() - begin)))
      all.add(candidate, vertices_of(surface, kind, candidate));
    PairFlags boxes_apart;
    find_apart_by_boxes(kind, all.pairs, vertices, box_separation, boxes_apart);
    for (std::size_t k = 0; k < all.pairs.count; ++k) {
      if (boxes_apart[k] != 0) continue;
      const std::array<Index, 4> pair = all.pairs.vertices_of(k);
      const Vector3& motion = motions.has_own_frames()
                                  ? motions.of_pair(surface.body_of(pair[0]), surface.body_of(pair[3]))
                                  : motions.common;
      if (near.pairs.count == PairBlock::capacity || motion != same_step.motion) append_near();
      same_step.motion = motion;
      near.add(all.candidates[k], pair);
    }
  }
  append_near();
}

}  // namespace stiv
