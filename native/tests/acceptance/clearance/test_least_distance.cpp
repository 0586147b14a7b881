// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <random>

#include "stiv/acceptance/intersections.hpp"
#include "stiv/acceptance/least_distance.hpp"

using namespace stiv;

namespace {

/// Small triangles at random places, assigned to three bodies in turn.
struct Scattering {
  std::shared_ptr<const Surface> surface;
  Positions q;

  Scattering(Index count, unsigned seed, double scale, std::vector<std::pair<Index, Index>> ignored = {}) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    SurfaceDefinition definition;
    definition.vertex_count = 3 * count;
    definition.triangles.resize(count, 3);
    definition.bodies = {{"a", Mobility::deformable}, {"b", Mobility::deformable}, {"c", Mobility::rigid}};
    definition.ignored = std::move(ignored);
    q.resize(3 * count, 3);
    for (Index triangle = 0; triangle < count; ++triangle) {
      const Vector3 centre = Vector3::NullaryExpr([&] { return normal(random); });
      for (Index corner = 0; corner < 3; ++corner) {
        const Index vertex = 3 * triangle + corner;
        definition.triangles(triangle, corner) = vertex;
        definition.vertex_body.push_back(triangle % 3);
        q.row(vertex) = scale * (centre + 0.05 * Vector3::NullaryExpr([&] { return normal(random); })).transpose();
      }
    }
    surface = std::make_shared<Surface>(definition);
  }

  Index body(Index triangle) const { return surface->body_of(surface->triangles()(triangle, 0)); }
};

/// Distance of two triangles by alternating projections onto convex sets: sampled barycentric coordinates, refined.
/// Coarse, but independent: never less than the true distance, and close to it.
double sampled_distance(const Scattering& scene, Index first, Index second) {
  const auto corner = [&](Index triangle, int k) -> Vector3 {
    return scene.q.row(scene.surface->triangles()(triangle, k));
  };
  const auto point = [&](Index triangle, double u, double v) -> Vector3 {
    return (1 - u - v) * corner(triangle, 0) + u * corner(triangle, 1) + v * corner(triangle, 2);
  };
  Eigen::Vector4d best(1.0 / 3, 1.0 / 3, 1.0 / 3, 1.0 / 3);
  const auto length = [&](const Eigen::Vector4d& x) {
    return (point(first, x[0], x[1]) - point(second, x[2], x[3])).norm();
  };
  const auto inside = [](double& u, double& v) {
    u = std::max(u, 0.0);
    v = std::max(v, 0.0);
    if (const double sum = u + v; sum > 1) {
      u /= sum;
      v /= sum;
    }
  };
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  double least = length(best);
  for (double step = 0.5; step > 1e-7; step *= 0.97)
    for (int k = 0; k < 24; ++k) {
      Eigen::Vector4d trial = best + step * Eigen::Vector4d::NullaryExpr([&] { return normal(random); });
      inside(trial[0], trial[1]);
      inside(trial[2], trial[3]);
      if (length(trial) < least) {
        least = length(trial);
        best = trial;
      }
    }
  return least;
}

}  // namespace

TEST_CASE("least distance: the closest of all pairs, against a random search") {
  for (const double scale : {1.0, 1e-5, 1e6}) {
    const Scattering scene(24, 3, scale);
    const auto nearest = LeastDistance(scene.surface).find(scene.q);
    REQUIRE(nearest);
    double least = std::numeric_limits<double>::infinity();
    for (Index a = 0; a < 24; ++a)
      for (Index b = a + 1; b < 24; ++b)
        if (scene.body(a) != scene.body(b)) least = std::min(least, sampled_distance(scene, a, b));
    CHECK(nearest->distance <= least);
    CHECK(nearest->distance == doctest::Approx(least).epsilon(1e-4));
    CHECK(scene.body(nearest->triangles[0]) != scene.body(nearest->triangles[1]));
    CHECK((nearest->points[0] - nearest->points[1]).norm() == doctest::Approx(nearest->distance).epsilon(1e-9));
  }
}

TEST_CASE("least distance: ignored bodies are left out, and pairs within a body count on request") {
  const Scattering all(300, 4, 1), apart(300, 4, 1, {{0, 1}, {0, 2}, {1, 2}});
  CHECK_FALSE(LeastDistance(apart.surface).find(apart.q));
  const auto within = LeastDistance(apart.surface).find(apart.q, DistancePairs::all);
  REQUIRE(within);
  CHECK(apart.body(within->triangles[0]) == apart.body(within->triangles[1]));
  CHECK(apart.body(within->triangles[0]) != 2);  // a rigid body does not meet itself
  CHECK(LeastDistance(all.surface).find(all.q, DistancePairs::all)->distance <= within->distance);
}

TEST_CASE("least distance: zero exactly for intersecting pairs, and trees follow the positions") {
  Scattering scene(60, 8, 1);
  LeastDistance search(scene.surface);
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  int met = 0;
  for (int trial = 0; trial < 200; ++trial) {
    for (double& x : scene.q.reshaped()) x += 0.1 * normal(random);
    Execution execution(1);
    IndexPairs pairs = IntersectionTest(scene.surface).find(scene.q, execution);
    std::erase_if(pairs, [&](const auto& pair) { return scene.body(pair.first) == scene.body(pair.second); });
    CHECK((search.find(scene.q)->distance == 0) == !pairs.empty());
    met += !pairs.empty();
  }
  CHECK(met > 0);
  CHECK(met < 200);
}

TEST_CASE("least distance: neighbours do not count, and there may be no pair") {
  SurfaceDefinition definition;
  definition.vertex_count = 4;
  definition.triangles.resize(2, 3);
  definition.triangles << 0, 1, 2, 1, 2, 3;
  const auto surface = std::make_shared<Surface>(definition);
  Positions q(4, 3);
  q << 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0;
  CHECK_FALSE(LeastDistance(surface).find(q, DistancePairs::all));
  CHECK_FALSE(LeastDistance(std::make_shared<Surface>(SurfaceDefinition{})).find(Positions(0, 3)));
}
