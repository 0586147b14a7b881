// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/kept_pairs.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <utility>

#include "detection/close_pairs.hpp"

namespace stiv {

namespace {

/// Indices are not negative: both as one number.
std::uint64_t key(const Candidate& pair) {
  return static_cast<std::uint64_t>(pair.first) << 32 | static_cast<std::uint64_t>(pair.second);
}

constexpr auto before = [](const Candidate& a, const Candidate& b) { return key(a) < key(b); };

}  // namespace

void KeptPairs::add(EventKind kind, std::vector<Candidate> pairs) {
  if (kind == EventKind::edge_edge)  // which edge comes first depends on the order of a tree
    for (Candidate& pair : pairs)
      if (pair.second < pair.first) std::swap(pair.first, pair.second);
  std::sort(pairs.begin(), pairs.end(), before);
  std::vector<Candidate>& kept = pairs_[static_cast<std::size_t>(kind)];
  std::vector<Candidate> all;
  all.reserve(kept.size() + pairs.size());
  std::set_union(kept.begin(), kept.end(), pairs.begin(), pairs.end(), std::back_inserter(all), before);
  kept = std::move(all);
}

void KeptPairs::leave_close(const Surface& surface, const VertexSteps& vertices, const Vector3& motion,
                            double separation) {
  for (const EventKind kind : {EventKind::vertex_face, EventKind::edge_edge}) {
    std::vector<Candidate>& kept = pairs_[static_cast<std::size_t>(kind)];
    std::vector<Candidate> close;
    append_close(surface, kind, kept, vertices, motion, separation, close);
    kept = std::move(close);
  }
}

}  // namespace stiv
