// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <bit>
#include <numeric>

#include "detection/batches.hpp"
#include "detection/filters/coarse_hull_filter.hpp"

using namespace stiv;

namespace {

constexpr double slack = 1.0 / 1024;

CoarseFrame frame_around(const Batch& batch, const Vector3& motion) {
  const Vector3 low = batch.start.colwise().minCoeff().cwiseMin(batch.end.colwise().minCoeff()).transpose();
  const Vector3 high = batch.start.colwise().maxCoeff().cwiseMax(batch.end.colwise().maxCoeff()).transpose();
  const Vector3 centre = low / 2 + high / 2;
  return {centre, motion, (high - centre).cwiseMax(centre - low).maxCoeff()};
}

std::vector<unsigned char> flagged_coarsely(EventKind kind, const Batch& batch, double separation,
                                            const Vector3& motion = Vector3::Zero()) {
  const CoarseFrame frame = frame_around(batch, motion);
  const std::size_t count = batch.block.count;
  std::vector<CoarseStep> steps;
  std::int32_t reach = 0;
  for (Index row = 0; row < batch.start.rows(); ++row) {
    steps.push_back(frame.step(batch.start.row(row).data(), batch.end.row(row).data()));
    reach = std::max(reach, steps.back().reach());
  }
  const std::uint64_t apart =
      find_apart_by_coarse_hulls(kind, batch.block, steps.data(), {frame, separation, slack, reach});
  std::vector<unsigned char> flags(count);
  for (std::size_t k = 0; k < count; ++k) flags[k] = static_cast<unsigned char>(apart >> k & 1);
  return frame.is_valid() ? flags : std::vector<unsigned char>(count, 0);
}

std::vector<unsigned char> flagged_exactly(EventKind kind, const Batch& batch, double separation,
                                           const Vector3& motion = Vector3::Zero()) {
  const auto find = [&](EventKind of, const PairBlock& block, const VertexSteps& vertices, double h, PairFlags& apart) {
    find_apart_by_hulls(of, block, vertices, {motion, h, slack}, apart);
  };
  return flagged(find, kind, batch, separation);
}

/// Pairs that a random plane keeps apart by about `clearance`, with nearly parallel edges among them.
Batch nearly_touching(MotionMaker& make, EventKind kind, double clearance) {
  std::vector<PairMotion> motions;
  for (std::size_t pair = 0; pair < PairBlock::capacity; ++pair) {
    PairMotion motion = make.make(MotionMaker::general);
    const Eigen::Matrix3d turn = Eigen::Quaterniond::FromTwoVectors(Vector3::UnitX(), motion.end[0]).matrix();
    if (pair % 2 == 0) motion.start[3] = motion.start[2] + motion.start[1] - motion.start[0];
    const double error = std::pow(10, make.number(-10, -1)) * (pair % 3 == 0 ? -1 : 1);
    const std::size_t others = kind == EventKind::vertex_face ? 1 : 2;
    for (std::size_t k = 0; k < 4; ++k) {
      motion.start[k][2] = (k < others ? clearance * (1 + error) : 0) + std::pow(10, -6 - 3 * make.number(0, 1));
      motion.start[k] = turn * motion.start[k];
      motion.end[k] = motion.start[k];
    }
    motions.push_back(motion);
  }
  return Batch(motions);
}

/// The same motions, shorter and at another scale.
Batch shortened(const Batch& batch, double length, double scale) {
  std::vector<PairMotion> motions = batch.motions;
  for (PairMotion& motion : motions)
    for (std::size_t k = 0; k < 4; ++k) {
      motion.end[k] = scale * (motion.start[k] + length * (motion.end[k] - motion.start[k]));
      motion.start[k] *= scale;
    }
  return Batch(motions);
}

}  // namespace

TEST_CASE("coarse hull filter: what it calls apart keeps the separation, and every vector target says the same") {
  const auto find = [](EventKind kind, const PairBlock& block, const VertexSteps& vertices, double separation,
                       PairFlags& apart) {
    std::vector<PairMotion> motions(block.count);
    for (std::size_t k = 0; k < block.count; ++k)
      for (std::size_t v = 0; v < 4; ++v) {
        const VertexStep& step = vertices.data()[block.vertices[v][k]];
        motions[k].start[v] = Eigen::Map<const Vector3>(step.start);
        motions[k].end[v] = Eigen::Map<const Vector3>(step.end);
      }
    const auto flags = flagged_coarsely(kind, Batch(motions), separation);
    std::copy(flags.begin(), flags.end(), apart.begin());
  };
  const auto [apart, all] = check_filter(find, 29);
  CHECK(apart > all / 16);
  CHECK(apart < all);
}

TEST_CASE("coarse hull filter: it calls apart what the hull filter calls apart, and nothing else") {
  MotionMaker make(43);
  std::size_t coarse = 0, exact = 0;
  for (int sort = 0; sort < MotionMaker::sort_count; ++sort)
    for (const EventKind kind : {EventKind::vertex_face, EventKind::edge_edge})
      for (const double scale : {1e-16, 1e-3, 1.0, 1e12})
        for (const double length : {0.0, 1e-3, 0.2}) {
          const Batch batch = shortened(batch_of(make, sort, PairBlock::capacity), length, scale);
          const double separation = scale * std::pow(10, make.number(-6, -1));
          const Vector3 motion = scale * length * make.number(0, 1) * Vector3(1, -0.5, 0.25);
          const auto some = flagged_coarsely(kind, batch, separation, motion);
          const auto all = flagged_exactly(kind, batch, separation, motion);
          for (std::size_t k = 0; k < batch.block.count; ++k) CHECK(some[k] <= all[k]);
          if (sort == MotionMaker::sliver || sort == MotionMaker::far_away) continue;
          coarse += std::accumulate(some.begin(), some.end(), std::size_t{0});
          exact += std::accumulate(all.begin(), all.end(), std::size_t{0});
        }
  CHECK(exact > 2000);
  CHECK(static_cast<double>(coarse) > 0.98 * static_cast<double>(exact));
}

TEST_CASE("coarse hull filter: of pairs close to the limit, it calls none apart that the hull filter does not") {
  MotionMaker make(47);
  std::size_t coarse = 0, near = 0;
  for (int repeat = 0; repeat < 40; ++repeat)
    for (const EventKind kind : {EventKind::vertex_face, EventKind::edge_edge}) {
      const double separation = std::pow(10, make.number(-5, -1));
      const Batch batch = nearly_touching(make, kind, separation);
      const auto some = flagged_coarsely(kind, batch, separation), all = flagged_exactly(kind, batch, separation);
      for (std::size_t k = 0; k < batch.block.count; ++k) {
        CHECK(some[k] <= all[k]);
        coarse += some[k];
        near += all[k] == 0;
      }
    }
  CHECK(coarse > 200);
  CHECK(near > 200);
}

TEST_CASE("coarse hull filter: it is not used where products of coordinates could underflow") {
  CHECK(CoarseFrame(Vector3::Zero(), Vector3::Zero(), 1e-3).is_valid());
  CHECK_FALSE(CoarseFrame(Vector3::Zero(), Vector3::Zero(), 1e-60).is_valid());
}
