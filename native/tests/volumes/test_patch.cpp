// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <random>
#include <set>

#include "stiv/volumes/patch.hpp"

using namespace stiv;

namespace {

/// A strip of triangles 0-1-2, 1-2-3, ...: vertices i and j are neighbors when |i - j| <= 2.
Surface strip(Index vertices) {
  SurfaceDefinition definition;
  definition.vertex_count = vertices;
  definition.triangles.resize(vertices - 2, 3);
  for (Index face = 0; face < vertices - 2; ++face) definition.triangles.row(face) << face, face + 1, face + 2;
  return Surface(definition);
}

/// Labels found by passing the smallest one along every join until nothing changes.
std::vector<Index> labels_by_flooding(const std::vector<Region>& regions) {
  std::vector<Index> label(regions.size());
  for (std::size_t k = 0; k < label.size(); ++k) label[k] = static_cast<Index>(k);
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t a = 0; a < label.size(); ++a)
      for (std::size_t b = 0; b < label.size(); ++b) {
        const bool joined =
            std::abs(regions[a].vertex - regions[b].vertex) <= 2 || regions[a].event == regions[b].event;
        if (!joined || label[b] <= label[a]) continue;
        label[b] = label[a];
        changed = true;
      }
  }
  return label;
}

}  // namespace

TEST_CASE("patch: a partition by neighbours and events, equal to flooding") {
  const Surface surface = strip(200);
  std::mt19937 random(7);
  for (int trial = 0; trial < 50; ++trial) {
    std::set<Index> vertices;
    while (vertices.size() < 30) vertices.insert(static_cast<Index>(random() % 200));
    std::vector<Region> regions;
    for (const Index vertex : vertices) regions.push_back({vertex, static_cast<Index>(random() % 40)});
    const auto labels = patch_labels(surface, regions, ConstraintKind::per_patch);
    const auto expected = labels_by_flooding(regions);
    for (std::size_t a = 0; a < regions.size(); ++a)
      for (std::size_t b = 0; b < regions.size(); ++b) CHECK((labels[a] == labels[b]) == (expected[a] == expected[b]));
    Index next = 0;  // labels are numbered without gaps, in order of first appearance
    for (const Index label : labels) {
      CHECK(label <= next);
      next = std::max(next, label + 1);
    }
  }
}

TEST_CASE("patch: a single constraint has a single label") {
  const auto labels = patch_labels(strip(30), {{0, 0}, {10, 1}, {20, 2}}, ConstraintKind::single);
  CHECK(labels == std::vector<Index>{0, 0, 0});
}
