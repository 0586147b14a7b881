// SPDX-License-Identifier: GPL-3.0-or-later
#include "acceptance/intersection/candidate_test.hpp"

#include <utility>

#include "stiv/acceptance/intersections.hpp"

namespace stiv {

bool intersect(const Surface& surface, const CornerPair& corners, const PositionsView& q) {
  const auto& [a, b] = corners;
  return !surface.in_one_flip_face(std::array{a[0], a[1], a[2], b[0], b[1], b[2]}) && triangles_intersect(a, b, q);
}

CandidateTest::CandidateTest(const Surface& surface, const PositionsView& q, const PackedPoints& points,
                             NearPairs* near, Report report)
    : surface_(surface), q_(q), points_(points), near_(near), report_(std::move(report)) {}

bool CandidateTest::add(const PrimitivePair& pair, const CornerPair& corners) {
  if (share_corner(corners.first, corners.second)) {
    list(corners);
    return !intersect(surface_, corners, q_) || report_(pair);
  }
  pairs_[block_.count] = pair;
  corners_[block_.count] = corners;
  block_.add(corners.first, corners.second);
  return block_.count < TrianglePairs::capacity || finish();
}

bool CandidateTest::finish() {
  TriangleFlags separated;
  find_separated(block_, points_, near_ == nullptr ? 0 : near_->reach, separated);
  const std::size_t count = std::exchange(block_.count, 0);
  for (std::size_t k = 0; k < count; ++k) {
    if (separated[k]) continue;
    list(corners_[k]);
    if (intersect(surface_, corners_[k], q_) && !report_(pairs_[k])) return false;
  }
  return true;
}

void CandidateTest::list(const CornerPair& corners) {
  if (near_ != nullptr) near_->pairs.push_back(corners);
}

}  // namespace stiv
