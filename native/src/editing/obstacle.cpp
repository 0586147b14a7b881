// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/editing/obstacle.hpp"

#include <algorithm>
#include <utility>

#include "stiv/coordinate_range.hpp"
#include "stiv/error.hpp"

namespace stiv {

namespace {

constexpr Index block_size = 128;  // triangles
constexpr Index blocks_per_chunk = 64;
constexpr Index vertices_per_chunk = 8192;

std::string describe(const std::string& name, const char* element, Index number) {
  return "object \"" + name + "\", " + element + " " + std::to_string(number) + ": ";
}

void check_positions(const std::string& name, const Positions& q, const Execution& execution) {
  execution.for_chunks(static_cast<Index>(q.rows()), vertices_per_chunk, [&](Index begin, Index end, Index) {
    for (Index vertex = begin; vertex < end; ++vertex)
      for (Index axis = 0; axis < 3; ++axis)
        if (const char* fault = coordinate_fault(q(vertex, axis)))
          throw InputError(describe(name, "vertex", vertex) + fault);
  });
}

void check_corners(const std::string& name, const Triangles& triangles, Index triangle, Index vertex_count) {
  for (Index k = 0; k < 3; ++k)
    if (triangles(triangle, k) < 0 || triangles(triangle, k) >= vertex_count)
      throw InputError(describe(name, "face", triangle) + "vertex index " + std::to_string(triangles(triangle, k)) +
                       " is out of range 0.." + std::to_string(vertex_count - 1));
}

}  // namespace

Obstacle::Obstacle(std::string name, Positions positions, Triangles triangles, const Execution& execution)
    : name_(std::move(name)), positions_(std::move(positions)), triangles_(std::move(triangles)) {
  check_positions(name_, positions_, execution);
  const auto count = static_cast<Index>(triangles_.rows());
  blocks_.resize(at(Execution::chunk_count(count, block_size)));
  execution.for_chunks(count, block_size * blocks_per_chunk, [&](Index begin, Index end, Index) {
    for (Index triangle = begin; triangle < end; ++triangle) {
      check_corners(name_, triangles_, triangle, static_cast<Index>(positions_.rows()));
      Eigen::AlignedBox3d& block = blocks_[at(triangle / block_size)];
      for (const Index corner : triangles_.row(triangle)) block.extend(Vector3(positions_.row(corner)));
    }
  });
}

Index Obstacle::count_near(const Eigen::AlignedBox3d& box) const {
  const auto near =
      std::count_if(blocks_.begin(), blocks_.end(), [&](const auto& each) { return each.intersects(box); });
  return std::min(static_cast<Index>(near) * block_size, static_cast<Index>(triangles_.rows()));
}

std::vector<Index> Obstacle::triangles_near(const Eigen::AlignedBox3d& box, const Execution& execution,
                                            double distance) const {
  const auto is_near = [&](const Eigen::AlignedBox3d& each) {
    return each.intersects(box) || (distance > 0 && each.exteriorDistance(box) <= distance);
  };
  const auto count = static_cast<Index>(blocks_.size());
  std::vector<std::vector<Index>> found(at(Execution::chunk_count(count, blocks_per_chunk)));
  execution.for_chunks(count, blocks_per_chunk, [&](Index begin, Index end, Index chunk) {
    for (Index block = begin; block < end; ++block) {
      if (!is_near(blocks_[at(block)])) continue;
      const Index last = std::min((block + 1) * block_size, static_cast<Index>(triangles_.rows()));
      for (Index triangle = block * block_size; triangle < last; ++triangle) {
        Eigen::AlignedBox3d bounds;
        for (const Index corner : triangles_.row(triangle)) bounds.extend(Vector3(positions_.row(corner)));
        if (is_near(bounds)) found[at(chunk)].push_back(triangle);
      }
    }
  });
  std::size_t near = 0;
  for (const std::vector<Index>& some : found) near += some.size();
  std::vector<Index> triangles;
  triangles.reserve(near);
  for (const std::vector<Index>& some : found) triangles.insert(triangles.end(), some.begin(), some.end());
  return triangles;
}

std::optional<Vector3> Obstacle::corner_near(const Vector3& point, double distance) const {
  std::optional<Vector3> nearest;
  for (Index block = 0; block < static_cast<Index>(blocks_.size()); ++block) {
    if (blocks_[at(block)].exteriorDistance(point) >= distance) continue;
    const Index last = std::min((block + 1) * block_size, static_cast<Index>(triangles_.rows()));
    for (Index triangle = block * block_size; triangle < last; ++triangle)
      for (const Index corner : triangles_.row(triangle)) {
        const Vector3 position = positions_.row(corner);
        const double found = (position - point).norm();
        if (found < distance) distance = found, nearest = position;
      }
  }
  return nearest;
}

}  // namespace stiv
