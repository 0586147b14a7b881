// SPDX-License-Identifier: GPL-3.0-or-later
#include "acceptance/intersection/candidate_test.hpp"

#include <utility>

#include "stiv/acceptance/intersections.hpp"

namespace stiv {

CandidateTest::CandidateTest(const Surface& surface, const Primitives& first, const Primitives& second,
                             const PositionsView& q, const PackedPoints& points, NearPairs* near, Report report)
    : surface_(surface),
      first_(first),
      second_(second),
      q_(q),
      points_(points),
      near_(near),
      report_(std::move(report)) {}

bool CandidateTest::add(const PrimitivePair& pair) {
  const auto &a = first_.corners(pair.first), &b = second_.corners(pair.second);
  if (share_corner(a, b)) {
    list(pair);
    return !intersect(pair) || report_(pair);
  }
  pairs_[block_.count] = pair;
  block_.add(a, b);
  return block_.count < TrianglePairs::capacity || finish();
}

bool CandidateTest::finish() {
  TriangleFlags separated;
  find_separated(block_, points_, near_ == nullptr ? 0 : near_->reach, separated);
  const std::size_t count = std::exchange(block_.count, 0);
  for (std::size_t k = 0; k < count; ++k) {
    if (separated[k]) continue;
    list(pairs_[k]);
    if (intersect(pairs_[k]) && !report_(pairs_[k])) return false;
  }
  return true;
}

void CandidateTest::list(const PrimitivePair& pair) {
  if (near_ != nullptr) near_->pairs.push_back({first_.corners(pair.first), second_.corners(pair.second)});
}

bool CandidateTest::intersect(const PrimitivePair& pair) const {
  const auto &a = first_.corners(pair.first), &b = second_.corners(pair.second);
  return !surface_.in_one_flip_face(std::array{a[0], a[1], a[2], b[0], b[1], b[2]}) && triangles_intersect(a, b, q_);
}

}  // namespace stiv
