// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/kept_pairs.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <utility>

#include "detection/close_pairs.hpp"
#include "detection/relevance.hpp"

namespace stiv {

namespace {

constexpr EventKind kinds[] = {EventKind::vertex_face, EventKind::edge_edge};

/// Indices are not negative: both as one number.
std::uint64_t key(const Candidate& pair) {
  return static_cast<std::uint64_t>(pair.first) << 32 | static_cast<std::uint64_t>(pair.second);
}

constexpr auto before = [](const Candidate& a, const Candidate& b) { return key(a) < key(b); };

/// Adds pairs to sorted ones.
void unite(std::vector<Candidate>& kept, std::vector<Candidate> pairs) {
  std::sort(pairs.begin(), pairs.end(), before);
  std::vector<Candidate> all;
  all.reserve(kept.size() + pairs.size());
  std::set_union(kept.begin(), kept.end(), pairs.begin(), pairs.end(), std::back_inserter(all), before);
  kept = std::move(all);
}

}  // namespace

void KeptPairs::add(const Surface& surface, ClosePairs pairs) {
  for (Candidate& pair : pairs[1])  // which of two edges comes first depends on the order of a tree
    if (pair.second < pair.first) std::swap(pair.first, pair.second);
  for (std::size_t kind = 0; kind < pairs.size(); ++kind) unite(pairs_[kind], std::move(pairs[kind]));
  list_vertices(surface);
}

// What is far goes first: it is most of what a search gives, and need not be sorted.
void KeptPairs::add_and_leave_close(const Surface& surface, ClosePairs pairs, const VertexSteps& vertices,
                                    const Vector3& motion, double separation) {
  for (ClosePairs* const all : {&pairs_, &pairs})
    for (const EventKind kind : kinds) {
      std::vector<Candidate>& some = (*all)[static_cast<std::size_t>(kind)];
      std::vector<Candidate> close;
      append_close(surface, kind, some, vertices, motion, separation, close);
      some = std::move(close);
    }
  add(surface, std::move(pairs));
}

void KeptPairs::list_vertices(const Surface& surface) {
  std::vector<unsigned char> listed(static_cast<std::size_t>(surface.vertex_count()), 0);
  for (const EventKind kind : kinds)
    for (const Candidate& pair : of(kind))
      for (const Index vertex : vertices_of(surface, kind, pair)) listed[static_cast<std::size_t>(vertex)] = 1;
  vertices_.clear();
  for (Index vertex = 0; vertex < surface.vertex_count(); ++vertex)
    if (listed[static_cast<std::size_t>(vertex)] != 0) vertices_.push_back(vertex);
}

}  // namespace stiv
