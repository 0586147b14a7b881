// SPDX-License-Identifier: GPL-3.0-or-later
#include "penetration/overlap_watch.hpp"

#include <doctest/doctest.h>

#include <random>

#include "penetration/boxes.hpp"

using namespace stiv;

namespace {

constexpr double rounding = 1e-7;
const Eigen::Affine3d unit = Eigen::Affine3d::Identity();

/// Two bodies of a scene that may overlap; the first one moves.
struct Watched {
  Watched(const Assembly& scene, Index count_of_first)
      : start(scene.q), first_count(count_of_first), watch(*scene.surface(), {{1, 0}}, rounding) {
    CHECK_FALSE(watch.begun());
    watch.begin(start, execution);
    CHECK(watch.begun());
  }

  Positions moved(const Vector3& offset) const {
    Positions q = start;
    q.topRows(first_count).rowwise() += offset.transpose();
    return q;
  }
  bool is_deeper(const Vector3& offset) { return watch.is_deeper(moved(offset), execution); }
  bool overlaps(const Vector3& offset) { return watch.overlapping(moved(offset), execution)[0] != 0; }
  double free_fraction(const Vector3& offset) { return watch.free_fraction(start, moved(offset), execution); }

  Execution execution{1};
  Positions start;
  Index first_count;
  OverlapWatch watch;
};

Assembly boxes_at(const Vector3& offset) {
  Assembly scene;
  add_box(scene, unit);
  add_box(scene, Eigen::Affine3d(Eigen::Translation3d(offset)));
  return scene;
}

/// The common volume of two cubes of side 4 whose centers differ by `offset`.
double common_volume(const Vector3& offset) { return (4 - offset.cwiseAbs().array()).cwiseMax(0).prod(); }

}  // namespace

TEST_CASE("boxes may move wherever their common volume does not grow, as computed from their sides") {
  const Vector3 offset(3.5, 0.3, 0.2);
  Watched boxes(boxes_at(offset), 8);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  int deeper = 0;
  for (int k = 0; k < 200; ++k) {
    const Vector3 motion(uniform(random), uniform(random), uniform(random));
    const double before = common_volume(offset), after = common_volume(offset - motion);
    if (std::abs(after - before) < 1e-5) continue;
    CHECK(boxes.is_deeper(motion) == (after > before));
    CHECK(boxes.overlaps(motion) == (after > 0));
    deeper += after > before;
  }
  CHECK(deeper > 20);
  CHECK(deeper < 180);
}

TEST_CASE("a step ends where bodies come apart, and before it would go deeper") {
  Watched boxes(boxes_at({3.5, 0.3, 0.2}), 8);
  const double parting = boxes.free_fraction({-2, 0, 0});  // apart at a quarter
  CHECK(parting >= 0.25);
  CHECK(parting < 0.35);
  CHECK_FALSE(boxes.overlaps({-2 * parting, 0, 0}));
  CHECK(boxes.free_fraction({-0.3, 0.1, 0}) == 1);
  CHECK(boxes.free_fraction({0, 0, 0}) == 1);
  CHECK(boxes.free_fraction({0.3, 0, 0}) < 0.5);
  CHECK(boxes.free_fraction({20, 0, 0}) < 0.1);  // apart at its end, deeper on the way
}

TEST_CASE("bodies that move together neither part nor go deeper") {
  Watched boxes(boxes_at({3.5, 0.3, 0.2}), 8);
  Positions both = boxes.start;
  both.rowwise() += Eigen::RowVector3d(100, 30, -7);
  CHECK(boxes.watch.free_fraction(boxes.start, both, boxes.execution) == 1);
}

TEST_CASE("a box inside another one overlaps it") {
  Assembly scene;
  add_box(scene, Eigen::Affine3d(Eigen::Scaling(0.2)));
  add_box(scene, unit);
  Watched boxes(scene, 8);
  CHECK(boxes.overlaps({0, 0, 0}));
  CHECK(boxes.overlaps({2, 0, 0}));
  CHECK_FALSE(boxes.overlaps({3, 0, 0}));
  CHECK_FALSE(boxes.is_deeper({2, 0, 0}));
}

TEST_CASE("open bodies may part, and intersect along no longer curve") {
  Assembly scene;
  add_sheet(scene, 4, Eigen::Translation3d(0.1, 0.2, 0.3) * Eigen::AngleAxisd(1.2, Vector3(1, 0.2, 0.1).normalized()));
  add_sheet(scene, 4, unit);
  Watched sheets(scene, 25);
  CHECK(sheets.overlaps({0, 0, 0}));
  for (const Vector3& way : {Vector3(0, 0, 2), Vector3(0, 0, -2), Vector3(3, 0, 0)}) {
    CHECK_FALSE(sheets.is_deeper(way));
    CHECK_FALSE(sheets.overlaps(way));
  }
  CHECK_FALSE(sheets.is_deeper({0.2, 0, 0.1}));
}

TEST_CASE("other bodies are not measured, whatever they intersect") {
  Assembly scene = boxes_at({3.5, 0.3, 0.2});
  add_box(scene, Eigen::Affine3d(Eigen::Translation3d(1, 1, 1)));
  Watched boxes(scene, 8);
  CHECK(boxes.watch.pairs() == BodyPairs{{0, 1}});
  CHECK_FALSE(boxes.is_deeper({-0.1, 0, 0}));  // deeper in the third box
}
