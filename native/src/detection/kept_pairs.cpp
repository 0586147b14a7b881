// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/kept_pairs.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "detection/broad_phase/relevance.hpp"
#include "detection/close_pairs.hpp"
#include "detection/pair_key.hpp"

namespace stiv {

namespace {

constexpr EventKind kinds[] = {EventKind::vertex_face, EventKind::edge_edge};

constexpr auto before = [](const Candidate& a, const Candidate& b) {
  return pair_key(a.first, a.second) < pair_key(b.first, b.second);
};

/// Sorted pairs and others, each once.
std::vector<Candidate> united(const std::vector<Candidate>& sorted, std::vector<Candidate> others) {
  std::sort(others.begin(), others.end(), before);
  std::vector<Candidate> all;
  all.reserve(sorted.size() + others.size());
  std::set_union(sorted.begin(), sorted.end(), others.begin(), others.end(), std::back_inserter(all), before);
  return all;
}

/// Of both kinds. Which of two edges comes first depends on the order of a tree: here the lower one.
ClosePairs united(const ClosePairs& sorted, ClosePairs others, const Execution& execution) {
  for (Candidate& pair : others[1])
    if (pair.second < pair.first) std::swap(pair.first, pair.second);
  ClosePairs all;
  execution.for_chunks(2, 1, [&](Index, Index, Index number) {
    const auto kind = static_cast<std::size_t>(number);
    all[kind] = united(sorted[kind], std::move(others[kind]));
  });
  return all;
}

}  // namespace

void KeptPairs::add(const Surface& surface, ClosePairs pairs, const Execution& execution) {
  take(surface, united(pairs_, std::move(pairs), execution));
}

// What is far goes first: it is most of what a search gives, and need not be sorted.
void KeptPairs::add_and_leave_close(const Surface& surface, const ClosePairs& pairs, const VertexSteps& vertices,
                                    const Vector3& motion, double separation, const Execution& execution) {
  ClosePairs kept, added;
  execution.for_chunks(4, 1, [&](Index, Index, Index number) {
    const auto kind = static_cast<std::size_t>(number % 2);
    const bool first = number < 2;
    append_close(surface, kinds[kind], (first ? pairs_ : pairs)[kind], vertices, motion, separation,
                 (first ? kept : added)[kind]);
  });
  take(surface, united(kept, std::move(added), execution));
}

/// Only here anything changes: what comes before may be interrupted.
void KeptPairs::take(const Surface& surface, ClosePairs pairs) {
  std::vector<unsigned char> listed(static_cast<std::size_t>(surface.vertex_count()), 0);
  for (std::size_t kind = 0; kind < pairs.size(); ++kind)
    for (const Candidate& pair : pairs[kind])
      for (const Index vertex : vertices_of(surface, kinds[kind], pair)) listed[static_cast<std::size_t>(vertex)] = 1;
  pairs_ = std::move(pairs);
  vertices_.clear();
  for (Index vertex = 0; vertex < surface.vertex_count(); ++vertex)
    if (listed[static_cast<std::size_t>(vertex)] != 0) vertices_.push_back(vertex);
}

}  // namespace stiv
