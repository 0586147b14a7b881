// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/excluded_pairs.hpp"

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>

#include "stiv/error.hpp"

namespace stiv {

namespace {

IndexPairs checked(const IndexPairs& pairs, Index triangle_count) {
  IndexPairs ordered;
  for (const auto& [a, b] : pairs) {
    if (std::min(a, b) < 0 || std::max(a, b) >= triangle_count || a == b)
      throw InputError("exclude: (" + std::to_string(a) + ", " + std::to_string(b) + ") is not a pair of the " +
                       std::to_string(triangle_count) + " triangles");
    ordered.emplace_back(std::min(a, b), std::max(a, b));
  }
  std::sort(ordered.begin(), ordered.end());
  ordered.erase(std::unique(ordered.begin(), ordered.end()), ordered.end());
  return ordered;
}

}  // namespace

ExcludedPairs::ExcludedPairs(std::shared_ptr<const Surface> surface, const IndexPairs& pairs)
    : surface_(std::move(surface)), pairs_(checked(pairs, static_cast<Index>(surface_->triangles().rows()))) {
  if (pairs_.empty()) return;
  around_.resize(static_cast<std::size_t>(surface_->vertex_count()));
  const Triangles& triangles = surface_->triangles();
  for (Index triangle = 0; triangle < static_cast<Index>(triangles.rows()); ++triangle)
    for (int corner = 0; corner < 3; ++corner) {
      std::vector<Index>& around = around_[triangles(triangle, corner)];
      if (around.empty() || around.back() != triangle)
        around.push_back(triangle);  // once, even if the triangle is degenerate
    }
}

bool ExcludedPairs::contains(Index a, Index b) const {
  return std::binary_search(pairs_.begin(), pairs_.end(), std::pair(std::min(a, b), std::max(a, b)));
}

std::vector<Index> ExcludedPairs::triangles_with(const Index* begin, const Index* end) const {
  std::vector<Index> common = around_[static_cast<std::size_t>(*begin)];
  for (const Index* vertex = begin + 1; vertex != end; ++vertex) {
    const std::vector<Index>& other = around_[static_cast<std::size_t>(*vertex)];
    std::erase_if(common, [&](Index triangle) { return !std::binary_search(other.begin(), other.end(), triangle); });
  }
  return common;
}

bool ExcludedPairs::covers(const Event& event) const {
  const Index *const begin = event.vertices.data(), *const split = begin + first_side_size(event.kind);
  const std::vector<Index> first = triangles_with(begin, split);
  if (first.empty()) return false;  // a loose edge or vertex
  const std::vector<Index> second = triangles_with(split, begin + event.vertices.size());
  if (second.empty()) return false;
  for (const Index a : first)
    for (const Index b : second)
      if (!contains(a, b)) return false;
  return true;
}

void ExcludedPairs::remove_from(Events& events) const {
  if (!empty()) std::erase_if(events, [&](const Event& event) { return covers(event); });
}

IndexPairs ExcludedPairs::others(const IndexPairs& pairs) const {
  IndexPairs left;
  std::set_difference(pairs.begin(), pairs.end(), pairs_.begin(), pairs_.end(), std::back_inserter(left));
  return left;
}

}  // namespace stiv
