// SPDX-License-Identifier: GPL-3.0-or-later
#include "penetration/body_penetrations.hpp"

#include <doctest/doctest.h>

#include "penetration/boxes.hpp"

using namespace stiv;

namespace {

const Eigen::Affine3d unit = Eigen::Affine3d::Identity();

/// Two overlapping boxes, a sheet partly in both, and a second sheet that intersects the first.
Assembly scene_of_four() {
  Assembly scene;
  add_box(scene, unit);
  add_sheet(scene, 4, Eigen::Affine3d(Eigen::Translation3d(2, 0.1, 0.3)));
  add_box(scene, Eigen::Affine3d(Eigen::Translation3d(3.5, 0.3, 0.1)));
  add_sheet(scene, 4, Eigen::Translation3d(2.1, 0.2, 0.4) * Eigen::AngleAxisd(1.2, Vector3::UnitX()));
  return scene;
}

IndexPairs intersecting(const Assembly& scene) {
  Execution execution(1);
  return IntersectionTest(scene.surface()).find(scene.q, execution);
}

using BodyPair = std::array<Index, 2>;

struct Measured {
  explicit Measured(const Assembly& scene)
      : all(scene.surface(), intersecting(scene), scene.q, 0), found(all.pairs().size()) {
    update(scene, std::vector<unsigned char>(scene.definition.bodies.size(), 1));
  }
  void update(const Assembly& scene, const std::vector<unsigned char>& displaced) {
    all.update(found, displaced, scene.q, intersecting(scene));
  }
  double operator()(Index a, Index b) const {
    for (std::size_t k = 0; k < found.size(); ++k)
      if (all.pairs()[k].bodies == BodyPair{a, b}) return found[k].amount;
    return -1;
  }

  BodyPenetrations all;
  std::vector<Penetration> found;
};

}  // namespace

TEST_CASE("pairs of closed bodies and of an open and a closed one are measured, pairs of open ones are not") {
  const Measured measured(scene_of_four());
  std::vector<BodyPair> bodies;
  for (const auto& pair : measured.all.pairs()) bodies.push_back(pair.bodies);
  std::sort(bodies.begin(), bodies.end());
  CHECK(bodies == std::vector<BodyPair>{{0, 2}, {1, 0}, {1, 2}, {3, 0}, {3, 2}});
  CHECK(measured(1, 0) == doctest::Approx(2));
  CHECK(measured(0, 2) == doctest::Approx(0.5 * 3.7 * 3.9));
  CHECK(measured(1, 2) == doctest::Approx(3));
}

TEST_CASE("bodies that face inward have the same penetration") {
  Assembly scene = scene_of_four();
  const Measured outward(scene);
  scene.definition.triangles.topRows(12).rowwise().reverseInPlace();
  const Measured inward(scene);
  for (std::size_t k = 0; k < inward.found.size(); ++k)
    CHECK(inward.found[k].amount == doctest::Approx(outward.found[k].amount));
}

TEST_CASE("only pairs with a displaced body are updated, and areas are those of the start") {
  Assembly scene = scene_of_four();
  Measured measured(scene);
  scene.q.middleRows(8, 25).col(0).array() -= 0.5;  // the first sheet
  measured.update(scene, {0, 0, 0, 1});
  CHECK(measured(1, 0) == doctest::Approx(2));
  measured.update(scene, {0, 1, 0, 0});
  CHECK(measured(1, 0) == doctest::Approx(3));
  CHECK(measured(1, 2) == doctest::Approx(2));
  const double middle = scene.q.middleRows(8, 25).col(0).mean();
  scene.q.middleRows(8, 25).col(0) = 0.5 * (scene.q.middleRows(8, 25).col(0).array() - middle);  // narrower, inside
  measured.update(scene, {0, 1, 0, 0});
  CHECK(measured(1, 0) == doctest::Approx(4));
  CHECK(measured(1, 2) == 0);
}

TEST_CASE("closed and open components of a body count as two, in a box and with a sheet") {
  Assembly scene;
  add_box(scene, unit);
  add_sheet(scene, 4, Eigen::Affine3d(Eigen::Translation3d(2, 0.1, 5.3)));
  add_box(scene, Eigen::Affine3d(Eigen::Translation3d(3.5, 0.3, 0.1)));
  add_box(scene, Eigen::Affine3d(Eigen::Translation3d(3.2, 0.1, 5.1)));
  add_sheet(scene, 4, Eigen::Translation3d(-2, 0.2, 0.4) * Eigen::AngleAxisd(1.5, Vector3::UnitX()));
  scene.definition.vertex_body.assign(33, 0);
  for (const auto& [first, count] : {std::pair(1, 8), std::pair(2, 8), std::pair(3, 25)})
    scene.definition.vertex_body.insert(scene.definition.vertex_body.end(), static_cast<std::size_t>(count), first);
  const Measured measured(scene);
  using Pair = BodyPenetrations::Pair;
  CHECK(measured.all.pairs() ==
        std::vector<Pair>{{{0, 2}, {false, true}}, {{0, 1}, {true, true}}, {{3, 0}, {false, true}}});
  CHECK(measured.found[0].amount == doctest::Approx(2 * 1.8));
  CHECK(measured.found[1].amount == doctest::Approx(0.5 * 3.7 * 3.9));
  CHECK(measured.found[2].amount == doctest::Approx(2));
}

TEST_CASE("ignored pairs of bodies and a body with itself are not measured") {
  Assembly scene = scene_of_four();
  const IndexPairs pairs = intersecting(scene);
  scene.definition.ignored = {{0, 2}};
  CHECK(BodyPenetrations(scene.surface(), pairs, scene.q, 0).pairs().size() == 4);
  CHECK(BodyPenetrations(scene.surface(), {{0, 3}}, scene.q, 0).pairs().empty());
}
