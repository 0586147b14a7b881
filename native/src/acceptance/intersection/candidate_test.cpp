// SPDX-License-Identifier: GPL-3.0-or-later
#include "acceptance/intersection/candidate_test.hpp"

#include <utility>

#include "stiv/acceptance/intersections.hpp"

namespace stiv {

namespace {

bool share_corner(const std::array<Index, 3>& a, const std::array<Index, 3>& b) {
  bool shared = false;
  for (const Index corner : a) shared |= (corner == b[0]) | (corner == b[1]) | (corner == b[2]);
  return shared;
}

}  // namespace

CandidateTest::CandidateTest(const Surface& surface, const Primitives& first, const Primitives& second,
                             const PositionsView& q, const PackedPoints& points, Report report)
    : surface_(surface), first_(first), second_(second), q_(q), points_(points), report_(std::move(report)) {}

bool CandidateTest::add(const PrimitivePair& pair) {
  const auto &a = first_.corners(pair.first), &b = second_.corners(pair.second);
  if (share_corner(a, b)) return !intersect(pair) || report_(pair);
  pairs_[block_.count] = pair;
  block_.add(a, b);
  return block_.count < TrianglePairs::capacity || finish();
}

bool CandidateTest::finish() {
  TriangleFlags separated;
  find_separated(block_, points_, separated);
  const std::size_t count = std::exchange(block_.count, 0);
  for (std::size_t k = 0; k < count; ++k)
    if (!separated[k] && intersect(pairs_[k]) && !report_(pairs_[k])) return false;
  return true;
}

bool CandidateTest::intersect(const PrimitivePair& pair) const {
  const auto &a = first_.corners(pair.first), &b = second_.corners(pair.second);
  return !surface_.in_one_flip_face(std::array{a[0], a[1], a[2], b[0], b[1], b[2]}) && triangles_intersect(a, b, q_);
}

}  // namespace stiv
