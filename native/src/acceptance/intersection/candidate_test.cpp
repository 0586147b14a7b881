// SPDX-License-Identifier: GPL-3.0-or-later
#include "acceptance/intersection/candidate_test.hpp"

#include <utility>

#include "stiv/acceptance/intersections.hpp"

namespace stiv {

namespace {

CornerPair corners_of(const TrianglePairs& block, std::size_t k) {
  const auto& corners = block.corners;
  return {{corners[0][k], corners[1][k], corners[2][k]}, {corners[3][k], corners[4][k], corners[5][k]}};
}

}  // namespace

bool intersect(const Surface& surface, const CornerPair& corners, const PositionsView& q) {
  const auto& [a, b] = corners;
  return !surface.in_one_flip_face(std::array{a[0], a[1], a[2], b[0], b[1], b[2]}) && triangles_intersect(a, b, q);
}

CandidateTest::CandidateTest(const Surface& surface, const PositionsView& q, const PackedPoints& points,
                             NearPairs* near, Report report)
    : surface_(surface), q_(q), points_(points), near_(near), report_(std::move(report)) {}

bool CandidateTest::test_neighbours(const PrimitivePair& pair, const CornerPair& corners) {
  list(corners);
  return !intersect(surface_, corners, q_) || report_(pair);
}

bool CandidateTest::finish() {
  TriangleFlags separated;
  find_separated(block_, points_, near_ == nullptr ? 0 : near_->reach, separated);
  const std::size_t count = std::exchange(block_.count, 0);
  for (std::size_t k = 0; k < count; ++k) {
    if (separated[k]) continue;
    const CornerPair corners = corners_of(block_, k);
    list(corners);
    if (intersect(surface_, corners, q_) && !report_(pairs_[k])) return false;
  }
  return true;
}

void CandidateTest::list(const CornerPair& corners) {
  if (near_ != nullptr) near_->pairs.push_back(corners);
}

}  // namespace stiv
