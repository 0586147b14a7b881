// SPDX-License-Identifier: GPL-3.0-or-later
#include "acceptance/intersection/stars.hpp"

#include <algorithm>
#include <array>
#include <span>

#include "acceptance/intersection/star_proof.hpp"

namespace stiv {

namespace {

/// The edge of a triangle opposite to a vertex, in the triangle's orientation.
struct LinkEdge {
  Index from, to;
};

/// Link edges of each vertex, in compressed rows.
struct LinkEdgeTable {
  std::vector<std::size_t> start;
  std::vector<LinkEdge> edges;

  LinkEdgeTable(std::span<const std::array<Index, 3>> triangles, Index vertex_count) : start(at(vertex_count) + 2, 0) {
    for (const auto& corners : triangles)
      for (const Index corner : corners) ++start[at(corner) + 2];
    for (std::size_t k = 2; k < start.size(); ++k) start[k] += start[k - 1];
    edges.resize(3 * triangles.size());
    for (const auto& [a, b, c] : triangles) {
      edges[start[at(a) + 1]++] = {b, c};
      edges[start[at(b) + 1]++] = {c, a};
      edges[start[at(c) + 1]++] = {a, b};
    }
  }
  std::span<LinkEdge> of(Index vertex) {
    return {edges.data() + start[at(vertex)], edges.data() + start[at(vertex) + 1]};
  }
};

/// Orders link edges so that each begins where the previous one ends. Returns false if they are not a single chain
/// without repeated vertices.
bool chain(std::span<LinkEdge> edges) {
  for (std::size_t k = 0; k < edges.size(); ++k)
    for (std::size_t other = 0; other < edges.size(); ++other)
      if (other != k && (edges[k].from == edges[other].from || edges[k].to == edges[other].to)) return false;
  const auto begins_chain = [&](const LinkEdge& edge) {
    return std::none_of(edges.begin(), edges.end(), [&](const LinkEdge& before) { return before.to == edge.from; });
  };
  const auto first = std::find_if(edges.begin(), edges.end(), begins_chain);
  if (first != edges.end()) std::swap(*first, edges.front());
  for (std::size_t k = 0; k + 1 < edges.size(); ++k) {
    const auto next = std::find_if(edges.begin() + static_cast<std::ptrdiff_t>(k) + 1, edges.end(),
                                   [&](const LinkEdge& edge) { return edge.from == edges[k].to; });
    if (next == edges.end()) return false;
    std::swap(*next, edges[k + 1]);
  }
  return true;
}

/// A single triangle has no pair of neighbors. Stars with very many triangles are left to the pair tests.
bool is_provable(Index vertex, std::span<LinkEdge> edges) {
  const auto repeats_corner = [vertex](const LinkEdge& edge) {
    return edge.from == vertex || edge.to == vertex || edge.from == edge.to;
  };
  return edges.size() > 1 && edges.size() <= StarBlock::most_triangles && std::ranges::none_of(edges, repeats_corner) &&
         chain(edges);
}

}  // namespace

Stars::Stars(std::span<const std::array<Index, 3>> triangles, Index vertex_count) {
  LinkEdgeTable table(triangles, vertex_count);
  start_.reserve(at(vertex_count) + 1);
  links_.reserve(table.edges.size() + at(vertex_count));
  for (Index vertex = 0; vertex < vertex_count; ++vertex) {
    start_.push_back(static_cast<Index>(links_.size()));
    const std::span<LinkEdge> edges = table.of(vertex);
    if (!is_provable(vertex, edges)) continue;
    stars_.push_back(vertex);
    for (const LinkEdge& edge : edges) links_.push_back(edge.from);
    links_.push_back(edges.back().to);
  }
  start_.push_back(static_cast<Index>(links_.size()));
  std::stable_sort(stars_.begin(), stars_.end(), [this](Index a, Index b) { return shape(a) < shape(b); });
}

template <class Skip>
void Stars::prove(std::span<const Index> stars, const PackedPoints& points, double reach, Proof proof,
                  const Skip& skips, std::vector<unsigned char>& proofs, const Execution& execution) const {
  constexpr Index chunk_size = 4096;
  execution.for_chunks(static_cast<Index>(stars.size()), chunk_size, [&](Index begin, Index end, Index) {
    StarBlock block;
    const auto prove_block = [&] {
      if (block.count == 0) return;
      const auto proven = prove_free(block, points, reach);
      for (std::size_t k = 0; k < block.count; ++k)
        if (proven[k]) proofs[at(block.vertices[k])] = proof;
      block.count = 0;
    };
    for (const Index vertex : stars.subspan(at(begin), at(end - begin))) {
      if (skips(vertex)) continue;
      const auto [triangles, closed] = shape(vertex);
      if (block.count == StarBlock::capacity || triangles != block.triangles || closed != block.closed) prove_block();
      block.triangles = triangles;
      block.closed = closed;
      block.vertices[block.count] = vertex;
      block.links[block.count] = link(vertex).data();
      ++block.count;
    }
    prove_block();
  });
}

void Stars::find_free(const PlacedVertices& placed, const std::vector<unsigned char>& moved, double reach,
                      std::vector<unsigned char>& proofs, const Execution& execution) const {
  proofs.resize(placed.points().size(), inconclusive);
  const auto is_unchanged = [&](Index vertex) {
    if (!placed.is_in_changed_body(vertex)) return true;
    proofs[at(vertex)] = inconclusive;
    return !has_moved(vertex, moved);
  };
  prove(stars_, placed.points(), reach, reach > 0 ? free_within_reach : free_here, is_unchanged, proofs, execution);
  if (reach == 0) return;
  const auto is_decided = [&](Index vertex) {
    return proofs[at(vertex)] != inconclusive || !placed.is_in_changed_body(vertex) || !has_moved(vertex, moved);
  };
  prove(stars_, placed.points(), 0, free_here, is_decided, proofs, execution);
}

std::vector<Index> Stars::find_open(const std::vector<unsigned char>& proofs,
                                    const std::vector<unsigned char>& moved) const {
  std::vector<Index> open;
  for (const Index vertex : stars_)
    if (proofs[at(vertex)] != free_within_reach && has_moved(vertex, moved)) open.push_back(vertex);
  return open;
}

bool Stars::has_moved(Index vertex, const std::vector<unsigned char>& moved) const {
  const auto is_marked = [&](Index each) { return moved[at(each)] != 0; };
  return moved.empty() || is_marked(vertex) || std::ranges::any_of(link(vertex), is_marked);
}

std::vector<Index> Stars::find_unproven(std::span<const Index> vertices, const PackedPoints& points,
                                        const Execution& execution) const {
  std::vector<unsigned char> proofs(points.size(), inconclusive);
  prove(
      vertices, points, 0, free_here, [](Index) { return false; }, proofs, execution);
  std::vector<Index> unproven;
  for (const Index vertex : vertices)
    if (proofs[at(vertex)] == inconclusive) unproven.push_back(vertex);
  return unproven;
}

std::pair<std::size_t, bool> Stars::shape(Index vertex) const {
  const std::span<const Index> around = link(vertex);
  return {around.size() - 1, around.front() == around.back()};
}

std::span<const Index> Stars::link(Index vertex) const {
  const auto begin = links_.begin() + start_[at(vertex)], end = links_.begin() + start_[at(vertex) + 1];
  return {begin, end};
}

}  // namespace stiv
