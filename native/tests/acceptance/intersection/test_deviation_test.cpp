// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include "acceptance/shapes.hpp"
#include "stiv/acceptance/deviation_test.hpp"
#include "stiv/acceptance/intersections.hpp"
#include "stiv/acceptance/step_check.hpp"
#include "stiv/error.hpp"

using namespace stiv;

namespace {

constexpr double reach = 0x1p-19;  // of the unit cube

double between(double low, double high, std::mt19937& random) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

/// Layers of a wavy sheet in the unit cube, a few reaches apart, with edges, vertices and a thin fin between them.
struct Layers {
  static constexpr Index side = 7, count = 4;

  Assembly scene;
  std::vector<Index> layer;  ///< of each vertex

  explicit Layers(std::mt19937& random) {
    double height = 0.3;
    for (Index k = 0; k < count; ++k) {
      add_layer(k, k % 2 == 0 ? Mobility::deformable : Mobility::rigid, height);
      height += between(1, 6, random) * reach;
    }
    add_loose(height);
    for (double& value : scene.q.reshaped()) value += between(-0.3, 0.3, random) * reach;
  }

 private:
  Index place(Index vertex, Index number, const Vector3& point) {
    layer.resize(static_cast<std::size_t>(scene.definition.vertex_count), number);
    scene.q.row(vertex) = point;
    return vertex;
  }

  /// The last column is a few reaches from the one before it: stars there are hard to prove.
  void add_layer(Index number, Mobility mobility, double height) {
    const Index base = scene.begin_body(side * side, mobility);
    for (Index i = 0; i < side; ++i) {
      for (Index j = 0; j < side; ++j) {
        const double x = 0.1 * i, y = j + 1 < side ? 0.1 * j : 0.1 * (j - 1) + 3 * reach;
        place(base + i * side + j, number, {x, y, height + 0.02 * std::sin(9 * x) * std::cos(7 * y)});
        if (i == 0 || j == 0) continue;
        const Index corner = base + i * side + j;
        scene.add_triangle(corner - side - 1, corner - side, corner);
        scene.add_triangle(corner - side - 1, corner, corner - 1);
      }
    }
  }

  /// Above the layers: two edges and a vertex, and a fan of three triangles on one edge.
  void add_loose(double height) {
    const Index base = scene.begin_body(10, Mobility::deformable);
    for (Index k = 0; k < 10; ++k) {
      const double x = 0.05 + 0.03 * k, y = 0.2 + 0.01 * (k % 3);
      place(base + k, count,
            {x, y, height + 0.02 * std::sin(9 * x) * std::cos(7 * y) + (k > 4 ? 0.01 * k : 2 * reach)});
    }
    scene.definition.loose_edges.resize(2, 2);
    scene.definition.loose_edges << base, base + 1, base + 2, base + 3;
    for (Index k = 7; k < 10; ++k) scene.add_triangle(base + 5, base + 6, base + k);
  }
};

/// Deviations of at most `size`: random ones, those that press layers onto each other, or those of single vertices.
Positions deviations(const Layers& layers, double size, int kind, std::mt19937& random) {
  Positions by = Positions::Zero(layers.scene.q.rows(), 3);
  for (Index row = 0; row < by.rows(); ++row) {
    const Index layer = layers.layer[static_cast<std::size_t>(row)];
    const double sign = layer % 2 == 0 ? 1 : -1;
    if (kind == 0)
      by.row(row) = Eigen::RowVector3d(between(-1, 1, random), between(-1, 1, random), between(-1, 1, random));
    if (kind == 1) by(row, 2) = sign;
    if (kind == 2 && random() % 40 == 0) by.row(row).setConstant(sign);
  }
  return size * by;
}

struct Counts {
  int free = 0, intersecting = 0, beyond = 0;
};

/// Compares the test with the complete one, for surfaces near an accepted one.
void compare(const Layers& layers, const std::shared_ptr<const Surface>& surface, const DeviationTest& test,
             const Positions& accepted, double scale, std::mt19937& random, Counts& counts) {
  for (int turn = 0; turn < 24; ++turn) {
    constexpr double sizes[] = {0.1, 0.6, 1 - 1e-9, 1 + 1e-6};
    const double size = sizes[turn % 4] * test.reach() / scale;
    const Positions q = accepted + scale * deviations(layers, size, turn % 3, random);
    const double largest = (q - accepted).cwiseAbs().maxCoeff();
    Execution execution(1 + turn % 3);
    const std::optional<bool> found = test.is_free(q, execution);
    CHECK(found.has_value() == (largest <= test.reach()));
    const bool expected = IntersectionTest(surface).is_free(q, {}, execution);
    if (found) CHECK(*found == expected);
    ++(!found ? counts.beyond : expected ? counts.free : counts.intersecting);
  }
}

/// Moves one layer; the others stay, and with them their pairs.
Positions with_layer_moved(const Layers& layers, Positions q, double size, std::mt19937& random) {
  const auto layer = static_cast<Index>(random() % (Layers::count + 1));
  for (Index row = 0; row < q.rows(); ++row)
    if (layers.layer[static_cast<std::size_t>(row)] == layer)
      for (double& value : q.row(row)) value += size * between(-1, 1, random);
  return q;
}

/// Tests another surface, and interrupts that at some point.
bool is_interrupted(IntersectionTest& test, const Positions& accepted, const Positions& q, std::mt19937& random) {
  Execution execution(1);
  auto checks_left = static_cast<int>(random() % 25);
  execution.cancel_when([&] { return --checks_left < 0; });
  try {
    test.is_free(q, moved_vertices(accepted, q, Execution(1)), execution);
    return false;
  } catch (const Interrupted&) {
    return true;
  }
}

}  // namespace

TEST_CASE("deviation test: equals the complete test within its reach, and says nothing beyond it") {
  std::mt19937 random(31);
  Counts counts;
  int interrupted = 0;
  for (const double scale : {1e-7, 1.0, 1e7}) {
    for (int trial = 0; trial < 12; ++trial) {
      const Layers layers(random);
      const auto surface = layers.scene.surface();
      IntersectionTest test(surface, {.lists_near_pairs = true});
      Execution execution(1 + trial % 3);
      Positions q = scale * layers.scene.q, accepted;
      for (int state = 0; state < 4; ++state) {
        std::vector<unsigned char> moved =
            state == 0 ? std::vector<unsigned char>() : moved_vertices(accepted, q, execution);
        const bool is_free =
            state % 2 == 0 && state < 2 ? test.find_all(q, execution).empty() : test.is_free(q, moved, execution);
        const auto near = test.deviation_test(q);
        CHECK((near != nullptr) == is_free);
        if (!is_free && state == 0) break;
        if (is_free) accepted = q;
        if (near) compare(layers, surface, *near, q, scale, random, counts);
        q = with_layer_moved(layers, accepted, 0.4 * scale * reach, random);
        interrupted +=
            is_interrupted(test, accepted, with_layer_moved(layers, accepted, scale * reach, random), random);
      }
    }
  }
  CHECK(counts.free > 100);
  CHECK(counts.intersecting > 100);
  CHECK(counts.beyond > 100);
  CHECK(interrupted > 30);
}

TEST_CASE("deviation test: belongs to the last surface without intersections, and outlives its search") {
  const Assembly linked = linked_tori(40, 20, 0), pulled = linked_tori(40, 20, 1.5);
  const auto surface = linked.surface();
  Execution execution(2);
  std::shared_ptr<const DeviationTest> near;
  {
    IntersectionTest test(surface, {.lists_near_pairs = true});
    CHECK(test.deviation_test(linked.q) == nullptr);
    CHECK(test.find_all(linked.q, execution).empty());
    near = test.deviation_test(linked.q);
    REQUIRE(near != nullptr);
    CHECK_FALSE(test.is_free(pulled.q, moved_vertices(linked.q, pulled.q, execution), execution));
    CHECK(test.deviation_test(pulled.q) == nullptr);
    CHECK(test.deviation_test(linked.q) != nullptr);
    CHECK(IntersectionTest(surface).deviation_test(linked.q) == nullptr);
  }
  CHECK(near->is_free(linked.q, execution) == std::optional(true));
  CHECK(near->is_free(pulled.q, execution) == std::nullopt);
  Positions broken = linked.q;
  broken(3, 1) = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(near->is_free(broken, execution), InputError);
  CHECK_THROWS_AS(near->is_free(broken.topRows(5), execution), InputError);
}
