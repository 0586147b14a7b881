// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <random>

#include "deformation/finite_differences.hpp"
#include "stiv/detection/narrow_phase.hpp"
#include "stiv/volumes/published.hpp"

using namespace stiv;

namespace {

/// A moving pair of primitives. The paper's narrow phase finds its contact for any end positions.
struct MovingPair {
  EventKind kind = EventKind::vertex_face;
  Proximity proximity;
  Positions start = Positions(4, 3), end = Positions(4, 3);

  Surface surface() const {
    SurfaceDefinition definition;
    definition.vertex_count = 4;
    return Surface(definition);
  }

  std::optional<Event> event(const Positions& at_end) const {
    PairMotion motion;
    for (Index k = 0; k < 4; ++k) {
      motion.start[static_cast<std::size_t>(k)] = start.row(k).transpose();
      motion.end[static_cast<std::size_t>(k)] = at_end.row(k).transpose();
    }
    const std::optional<Contact> contact = first_contact_by_polynomial(kind, motion, proximity);
    if (!contact) return std::nullopt;
    return Event{kind,
                 false,
                 {0, 1, 2, 3},
                 contact->time,
                 contact->weights,
                 contact->normal,
                 contact->start_distance,
                 contact->clearance};
  }

  /// The sum over both sides of A_i (1 - t) n . Dr_i. [P4, Eq. 3]
  Stiv stiv(const Positions& at_end) const {
    const Eigen::VectorXd areas = Eigen::VectorXd::LinSpaced(4, 0.3, 0.9);
    return published_volumes(surface(), {event(at_end).value()}, start, at_end, areas, ConstraintKind::single,
                             PublishedGradient::whole)
        .at(0);
  }
};

/// Do small changes leave the kind of contact as it is? It must be inside both primitives, at an angle, and not at the
/// start.
bool is_steady(const MovingPair& pair, const Event& event) {
  const Vector3 relative = weighted_sum(event, Positions(pair.end - pair.start));
  if (event.time < 0.1 || event.normal.dot(relative) > -0.2 * relative.norm()) return false;
  for (const double weight : event.weights)
    if (std::abs(weight) < 0.1) return false;
  const bool face = pair.kind == EventKind::vertex_face;  // the heaviest corner of each side owns the region
  if (!face)
    return std::abs(event.weights[0] - event.weights[1]) > 0.05 && std::abs(event.weights[2] - event.weights[3]) > 0.05;
  std::array<double, 3> sorted{event.weights[1], event.weights[2], event.weights[3]};
  std::sort(sorted.begin(), sorted.end());
  return sorted[1] - sorted[0] > 0.05;
}

/// Pairs in random motion that meet steadily.
std::vector<MovingPair> meeting_pairs(EventKind kind, double separation, std::size_t count) {
  std::vector<MovingPair> pairs;
  for (unsigned seed = 0; pairs.size() < count; ++seed) {
    MovingPair pair;
    pair.kind = kind;
    pair.proximity.separation = separation;
    pair.start = stiv::testing::random_positions(4, 2 * seed);
    pair.end = stiv::testing::random_positions(4, 2 * seed + 1);
    const std::optional<Event> event = pair.event(pair.end);
    if (event && is_steady(pair, *event)) pairs.push_back(pair);
  }
  return pairs;
}

void check_gradient(const MovingPair& pair) {
  const Positions gradient = stiv::testing::dense(pair.stiv(pair.end).gradient, 4);
  const double step = 1e-6;
  Positions slopes(4, 3);
  for (Index vertex = 0; vertex < 4; ++vertex)
    for (Index axis = 0; axis < 3; ++axis) {
      Positions forward = pair.end, backward = pair.end;
      forward(vertex, axis) += step;
      backward(vertex, axis) -= step;
      slopes(vertex, axis) = (pair.stiv(forward).volume - pair.stiv(backward).volume) / (2 * step);
    }
  CHECK((gradient - slopes).norm() < 1e-6 * slopes.norm());
}

/// A vertex 0 that falls from z = 1 to `depth` onto the triangle 1, 2, 3 in z = 0, which itself moves by `lift`.
struct Fall {
  Surface surface;
  Positions start = Positions(4, 3), end = Positions(4, 3);
  Event event;

  Fall(double depth, double lift) : surface(definition()) {
    start << 0.2, 0.3, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0;
    end = start;
    end(0, 2) = depth;
    end.col(2).tail(3).array() += lift;
    event.vertices = {0, 1, 2, 3};
    event.time = 1 / (1 - depth + lift);
    event.weights = {1, -0.5, -0.2, -0.3};
    event.normal = Vector3::UnitZ();
    event.start_distance = 1;
  }

  static SurfaceDefinition definition() {
    SurfaceDefinition definition;
    definition.vertex_count = 4;
    definition.triangles.resize(1, 3);
    definition.triangles << 1, 2, 3;
    return definition;
  }

  std::vector<Stiv> volumes(ConstraintKind kind, PublishedGradient gradient = PublishedGradient::frozen) const {
    Eigen::VectorXd areas(4);
    areas << 0.5, 2, 3, 5;
    return published_volumes(surface, {event}, start, end, areas, kind, gradient);
  }
};

}  // namespace

TEST_CASE("published volumes: a vertex that falls onto a face has (1 - t) of its own path times its area") {
  const std::vector<Stiv> stivs = Fall(-3, 0).volumes(ConstraintKind::per_patch);
  REQUIRE(stivs.size() == 1);  // the face has no motion, so no volume
  CHECK(stivs[0].volume == doctest::Approx(0.5 * (1 - 0.25) * -4));
  REQUIRE(stivs[0].gradient.index == std::vector<Index>{0});
  CHECK(stivs[0].gradient.value[0].isApprox(Vector3(0, 0, 0.5 * (1 - 0.25))));
}

TEST_CASE("published volumes: each side counts its own motion against the normal") {
  const Fall fall(-2, 2);  // they meet at 1/5
  const std::vector<Stiv> stivs = fall.volumes(ConstraintKind::per_patch);
  REQUIRE(stivs.size() == 2);  // joined only by neighboring vertices, the two sides are two patches
  CHECK(stivs[0].volume == doctest::Approx(0.5 * 0.8 * -3));
  CHECK(stivs[1].volume == doctest::Approx(2 * 0.8 * -2));  // in the region of vertex 1, the heaviest
  REQUIRE(stivs[1].gradient.index == std::vector<Index>{1, 2, 3});
  CHECK(stivs[1].gradient.value[1].isApprox(Vector3(0, 0, 2 * 0.8 * 0.2 * -1)));
  const std::vector<Stiv> single = fall.volumes(ConstraintKind::single);
  REQUIRE(single.size() == 1);
  CHECK(single[0].volume == doctest::Approx(stivs[0].volume + stivs[1].volume));
}

TEST_CASE("published volumes: a vertex that moves away counts too, as in the paper") {
  const Fall fall(-2, -1);  // the face moves down, more slowly than the vertex
  const std::vector<Stiv> stivs = fall.volumes(ConstraintKind::single);
  REQUIRE(stivs.size() == 1);
  const double remaining = 1 - fall.event.time;
  CHECK(stivs[0].volume == doctest::Approx(-remaining * (0.5 * 3 + 2 * 1)));
}

TEST_CASE("published volumes: a region keeps its earliest event") {
  const Fall fall(-3, 0);
  Event later = fall.event;
  later.time = 0.5;
  Eigen::VectorXd areas = Eigen::VectorXd::Ones(4);
  for (const Events& events : {Events{fall.event, later}, Events{later, fall.event}}) {
    const auto stivs = published_volumes(fall.surface, events, fall.start, fall.end, areas, ConstraintKind::per_patch,
                                         PublishedGradient::frozen);
    CHECK(stivs.at(0).volume == doctest::Approx(0.75 * -4));
  }
}

TEST_CASE("published volumes: the whole gradient is that of the volume, by finite differences") {
  for (const EventKind kind : {EventKind::vertex_face, EventKind::edge_edge})
    for (const double separation : {0.0, 0.02})
      for (const MovingPair& pair : meeting_pairs(kind, separation, 25)) check_gradient(pair);
}

TEST_CASE("published volumes: with the time in the gradient, a vertex that falls onto a face is lifted to the face") {
  const std::vector<Stiv> stivs = Fall(-3, 0).volumes(ConstraintKind::per_patch, PublishedGradient::whole);
  REQUIRE(stivs.size() == 1);
  REQUIRE(stivs[0].gradient.index == std::vector<Index>{0, 1, 2, 3});
  CHECK(stivs[0].gradient.value[0].isApprox(Vector3(0, 0, 0.5)));
  CHECK(stivs[0].gradient.value[1].isApprox(Vector3(0, 0, -0.25 * 0.5 * 0.5)));  // the face could move away: t w A
}
