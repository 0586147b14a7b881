// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/repair/repair.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "repair/component_shrinking.hpp"
#include "repair/tangled_scenes.hpp"
#include "stiv/deformation/linear.hpp"
#include "stiv/error.hpp"
#include "stiv/repair/contraction.hpp"

using namespace stiv;
using namespace stiv::tests;

namespace {

RepairResult repaired(const Scene& scene, const RepairOptions& options = {}, int threads = 1) {
  Execution execution(threads);
  return repair(scene.surface, scene.controls, options, execution);
}

IndexPairs pairs_at(const Scene& scene, const Positions& q) {
  Execution execution(1);
  return IntersectionTest(scene.surface).find(q, execution);
}

void check_unchanged(const Scene& scene, const RepairResult& result) {
  CHECK(result.positions == scene.controls);
  CHECK(result.pairs.faces == pairs_at(scene, scene.controls));
  CHECK_FALSE(result.pairs.empty());
}

/// Two coincident sheets, each a separate body.
Scene coincident_sheets() {
  Scene scene;
  Triangles triangles(0, 3);
  append_sheet(scene.controls, triangles, 3, 1, Vector3::Zero());
  append_sheet(scene.controls, triangles, 3, 1, Vector3::Zero());
  const Index count = static_cast<Index>(scene.controls.rows()) / 2;
  scene.surface = surface_of(triangles, count, count, Mobility::deformable, Mobility::deformable);
  return scene;
}

void append_upright_sheet(Positions& q, Triangles& triangles, Index cells, const Vector3& centre) {
  const Index first = static_cast<Index>(q.rows());
  append_sheet(q, triangles, cells, 1, Vector3::Zero());
  for (Index row = first; row < q.rows(); ++row)
    q.row(row) = Eigen::RowVector3d(q(row, 2), q(row, 1), q(row, 0)) + centre.transpose();
}

/// Two upright sheets through a level one near its ends, with the fewest vertices first. The middle of the first is
/// close to the level sheet, so it must become tiny; but not once the level sheet is half as long.
struct SheetsThroughSheet {
  static constexpr Index first = 25, level = 81;
  Scene scene;

  SheetsThroughSheet() {
    Triangles triangles(0, 3);
    append_upright_sheet(scene.controls, triangles, 4, Vector3(0.8, 0.02, 0.06));
    append_sheet(scene.controls, triangles, 8, 2, Vector3(0, 0.013, 0));
    append_upright_sheet(scene.controls, triangles, 10, Vector3(-0.8, 0.03, 0.01));
    scene.controls = scene.controls.cast<float>().cast<double>().eval();
    const Index count = static_cast<Index>(scene.controls.rows());
    scene.surface = surface_of(triangles, first, count - first, Mobility::deformable, Mobility::deformable);
    scene.deformation = make_identity(count);
  }
};

/// The components of a scene without a cage, all of them movable.
Contracted shrunk_components(const Scene& scene, int threads = 1) {
  Execution execution(threads);
  const CagedSurface caged = without_cage(scene.surface);
  const auto supports = supports_of(*caged.deformation);
  const Movable movable{Marks(supports.size(), 1), Marks(supports.size(), 1), supports};
  return shrink_components(caged, movable, {}, scene.controls, execution);
}

}  // namespace

TEST_CASE("a repaired surface passes the exact test and is close to the input") {
  const Scene scene = spike_through_sheet();
  const RepairResult result = repaired(scene);
  CHECK(result.status == RepairStatus::repaired);
  CHECK(result.pairs_before == static_cast<Index>(pairs_at(scene, scene.controls).size()));
  CHECK(pairs_at(scene, result.positions).empty());
  CHECK(result.pairs.empty());
  CHECK(result.positions == result.positions.cast<float>().cast<double>());
  const Eigen::RowVector3d size = scene.controls.colwise().maxCoeff() - scene.controls.colwise().minCoeff();
  const double rms = (result.positions - scene.controls).norm() / std::sqrt(double(scene.controls.rows()));
  CHECK(result.deviation == doctest::Approx(rms / size.norm()));
  CHECK(result.deviation < 0.02);
}

TEST_CASE("repair gives the same bits for any number of threads") {
  const Scene scene = spike_through_sheet();
  CHECK(repaired(scene, {}, 1).positions == repaired(scene, {}, 2).positions);
}

TEST_CASE("a surface without intersections stays unchanged") {
  const Scene scene = two_sheets();
  const RepairResult result = repaired(scene);
  CHECK(result.status == RepairStatus::already_free);
  CHECK(result.positions == scene.controls);
}

TEST_CASE("fixed bodies and vertices stay exactly") {
  const Index moving = 81;
  const auto check = [&](const Scene& scene, const RepairOptions& options) {
    const RepairResult result = repaired(scene, options);
    const Index held = scene.surface->vertex_count() - moving;
    CHECK(result.status == RepairStatus::repaired);
    CHECK(result.positions.bottomRows(held) == scene.controls.bottomRows(held));
  };
  check(spike_through_sheet(Mobility::deformable, Mobility::fixed), {});
  const Scene scene = spike_through_sheet();
  RepairOptions options;
  options.moves.assign(static_cast<std::size_t>(scene.surface->vertex_count()), 0);
  std::fill(options.moves.begin(), options.moves.begin() + moving, static_cast<unsigned char>(1));
  check(scene, options);
}

TEST_CASE("coincident triangles are refused") {
  const Scene scene = coincident_sheets();
  const RepairResult result = repaired(scene);
  CHECK(result.status == RepairStatus::refused);
  CHECK(result.refusal == RepairRefusal::coincident);
  check_unchanged(scene, result);
}

TEST_CASE("an intersection without movable vertices is refused") {
  const Scene scene = spike_through_sheet();
  RepairOptions options;
  options.moves.assign(static_cast<std::size_t>(scene.surface->vertex_count()), 0);
  const RepairResult result = repaired(scene, options);
  CHECK(result.refusal == RepairRefusal::held);
  check_unchanged(scene, result);
}

TEST_CASE("a surface that no contraction repairs is refused, with its pairs") {
  const Scene scene = spike_through_sheet();
  RepairOptions options;
  options.contraction.max_steps = 0;
  const RepairResult result = repaired(scene, options);
  CHECK(result.refusal == RepairRefusal::not_freed);
  check_unchanged(scene, result);
}

TEST_CASE("a repair above the maximum deviation is refused") {
  const Scene scene = spike_through_sheet();
  RepairOptions options;
  options.max_deviation = 1e-6;
  const RepairResult result = repaired(scene, options);
  CHECK(result.refusal == RepairRefusal::too_far);
  CHECK(result.deviation > options.max_deviation);
  check_unchanged(scene, result);
}

TEST_CASE("a repair cancelled at any time changes nothing") {
  const Scene scene = spike_through_sheet();
  for (int calls = 0; calls < 40; calls += 3) {
    Execution execution(1);
    int left = calls;
    execution.set_progress([&](const char*, double) {
      if (left-- == 0) execution.request_cancel();
    });
    const RepairResult result = repair(scene.surface, scene.controls, {}, execution);
    if (!execution.cancel_requested()) break;
    CHECK(result.status == RepairStatus::cancelled);
    check_unchanged(scene, result);
  }
}

TEST_CASE("a cage is contracted until its surface is free, and expanded back") {
  const Scene scene = spike_through_sheet();
  const Index count = scene.surface->vertex_count();
  WeightMatrix twice(count, count);
  twice.setIdentity();
  twice *= 2;
  const CagedSurface caged{scene.surface, make_linear(twice), scene.surface};
  Execution execution(1);
  const RepairResult result = repair(caged, scene.controls, {}, execution);
  CHECK(result.status == RepairStatus::repaired);
  CHECK(pairs_at(scene, 2 * result.positions).empty());
  CHECK(result.deviation == doctest::Approx(repaired(scene).deviation).epsilon(0.1));
  CHECK_THROWS_AS(repair({scene.surface, make_identity(count - 1), scene.surface}, scene.controls, {}, execution),
                  InputError);
  CHECK_THROWS_AS(repair(caged, scene.controls.topRows(count - 1), {}, execution), InputError);
}

TEST_CASE("components that smoothing cannot separate are shrunk") {
  const Scene scene = spike_through_sheet();  // two components
  const Contracted apart = shrunk_components(scene);
  CHECK(apart.pairs == 0);
  CHECK(pairs_at(scene, apart.positions).empty());
  // The moved component is scaled: all edges are shorter by the same factor.
  double least = 1, most = 0;
  for (const auto& corners : scene.surface->triangles().rowwise()) {
    const auto length = [&](const Positions& q) { return (q.row(corners[0]) - q.row(corners[1])).norm(); };
    const double ratio = length(apart.positions) / length(scene.controls);
    if (ratio < 0.99) {
      least = std::min(least, ratio);
      most = std::max(most, ratio);
    }
  }
  CHECK(most == doctest::Approx(least));
  CHECK(most <= doctest::Approx(0.5));
}

TEST_CASE("components grow again once others have made room") {
  const Scene scene = SheetsThroughSheet().scene;
  const Contracted apart = shrunk_components(scene);
  CHECK(apart.pairs == 0);
  CHECK(pairs_at(scene, apart.positions).empty());
  const auto size_ratio = [&](Index begin, Index count) {
    const auto size = [&](const Positions& q) {
      const auto rows = q.middleRows(begin, count);
      return (rows.colwise().maxCoeff() - rows.colwise().minCoeff()).norm();
    };
    return size(apart.positions) / size(scene.controls);
  };
  const Index first = SheetsThroughSheet::first, level = SheetsThroughSheet::level;
  CHECK(size_ratio(first, level) == doctest::Approx(0.5));
  CHECK(size_ratio(0, first) == doctest::Approx(0.5));
  CHECK(size_ratio(first + level, 121) == doctest::Approx(1));
  CHECK(shrunk_components(scene, 2).positions == apart.positions);
  // The first sheet cannot have this size beside the whole level one.
  Positions beside = scene.controls;
  beside.topRows(first) = apart.positions.topRows(first);
  CHECK_FALSE(pairs_at(scene, beside).empty());
}

TEST_CASE("expansion toward any target stays free of intersections") {
  const Scene scene = two_sheets();
  Positions target = scene.controls;
  target.topRows(49).col(2).array() -= 0.7;
  Execution execution(1);
  const EditResult result = expand(scene.surface, scene.controls, target, {}, execution);
  CHECK(result.status == EditStatus::corrected);
  CHECK(pairs_at(scene, result.surface).empty());
  CHECK(result.path.back() == result.controls);
  CHECK(result.energy < 0.03 * 0.5 * (scene.controls - target).squaredNorm());  // fraction measured: 0.0202
  CHECK_THROWS_AS(expand(spike_through_sheet().surface, spike_through_sheet().controls, target, {}, execution),
                  InputError);
}
