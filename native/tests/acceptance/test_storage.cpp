// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <random>

#include <doctest/doctest.h>
#include "deformation/handle_scenes.hpp"
#include "stiv/acceptance/storage.hpp"
#include "stiv/deformation/combination.hpp"
#include "stiv/deformation/handles.hpp"
#include "stiv/error.hpp"

using namespace stiv;
using namespace stiv::testing;

namespace {

class Sampler {
 public:
  explicit Sampler(unsigned seed) : random_(seed) {}
  double signed_unit() { return std::uniform_real_distribution<double>(-1, 1)(random_); }
  double magnitude() { return std::pow(10, 7 * signed_unit()); }
  double any_size() { return signed_unit() * magnitude(); }

  /// Rotation, non-uniform scale of any sign, shear and offset, each of a random size.
  Eigen::Matrix4d frame() {
    Eigen::Matrix4d frame = Eigen::Matrix4d::Identity();
    const auto turn = [&] {
      return Eigen::Quaterniond(signed_unit(), signed_unit(), signed_unit(), signed_unit()).normalized();
    };
    const Vector3 scale(signed_unit() + 1.01, -signed_unit() - 1.01, signed_unit() + 1.01);
    frame.topLeftCorner<3, 3>() =
        magnitude() * turn().toRotationMatrix() * scale.asDiagonal() * turn().toRotationMatrix();
    frame.topRightCorner<3, 1>() << any_size(), any_size(), any_size();
    return frame;
  }

 private:
  std::mt19937 random_;
};

bool same_bits(const Controls& a, const Controls& b) {
  return a.rows() == b.rows() && std::equal(a.data(), a.data() + a.size(), b.data(), [](double x, double y) {
           return x == y && std::signbit(x) == std::signbit(y);
         });
}

/// frame * float32(frame^-1 * x).
Controls read_back(const Controls& p, const Eigen::Matrix4d& frame) {
  const Eigen::Affine3d to_world(frame), to_local = to_world.inverse();
  Controls back(p.rows(), 3);
  for (Index row = 0; row < p.rows(); ++row) {
    Vector3 local = to_local * Vector3(p.row(row));
    for (double& coordinate : local) {
      const volatile float single = static_cast<float>(coordinate);
      coordinate = static_cast<double>(single);
    }
    back.row(row) = to_world * local;
  }
  return back;
}

/// Positions in the world whose coordinates, there or in the frame, differ by up to 14 orders of magnitude.
Controls points_of_any_size(const Eigen::Matrix4d& frame, Sampler& sample) {
  Controls p(20, 3);
  for (Index k = 0; k < p.size(); ++k) p.data()[k] = sample.any_size();
  for (Index row = 0; row < 10; ++row) p.row(row) = (frame * p.row(row).transpose().homogeneous()).head<3>();
  return p;
}

}  // namespace

TEST_CASE("as_stored: idempotent bit for bit in any frame at any magnitude") {
  Sampler sample(3);
  int plain_trips_that_change = 0;
  for (int round = 0; round < 5000; ++round) {
    const StorageFrame frame{0, 20, sample.frame()};
    const Controls once = as_stored(points_of_any_size(frame.frame, sample), {frame});
    REQUIRE(same_bits(as_stored(once, {frame}), once));
    const Controls trip = read_back(once, frame.frame);
    plain_trips_that_change += !same_bits(trip, once);
    REQUIRE(same_bits(as_stored(trip, {frame}), trip));
  }
  CHECK(plain_trips_that_change > 1000);
}

TEST_CASE("as_stored: differs from values read back only by rounding of doubles") {
  Sampler sample(5);
  for (int round = 0; round < 1000; ++round) {
    const StorageFrame frame{0, 20, sample.frame()};
    const Controls once = as_stored(points_of_any_size(frame.frame, sample), {frame});
    const Eigen::RowVector3d offset = frame.frame.topRightCorner<3, 1>();
    const Eigen::VectorXd size = once.rowwise().norm().array() + offset.norm();
    const Eigen::VectorXd change = (read_back(once, frame.frame) - once).rowwise().norm();
    for (Index row = 0; row < 20; ++row) REQUIRE(change[row] <= 1e-10 * size[row]);
  }
}

TEST_CASE("as_stored: nearest single precision value in the frame") {
  Sampler sample(4);
  for (int round = 0; round < 200; ++round) {
    const Eigen::Matrix4d frame = sample.frame();
    const Eigen::Vector4d local(sample.signed_unit(), sample.signed_unit(), sample.signed_unit(), 1);
    Controls p(1, 3);
    p.row(0) = (frame * local).head<3>();
    const Eigen::Vector4d stored = as_stored(p, {{0, 1, frame}}).row(0).transpose().homogeneous();
    const double lost = 0x1p-50 * frame.topRightCorner<3, 1>().norm() / frame.topLeftCorner<3, 3>().norm();
    CHECK(((frame.inverse() * stored) - local).norm() < 0x1p-24 * 1.8 + 1e4 * lost);
  }
}

TEST_CASE("as_stored: float32 in the identity, untouched outside the frames") {
  Controls p(3, 3);
  p << 0.1, 0.2, 0.3, 0.1, 0.2, 0.3, -1e-7, 1e7, 0.1;
  const Controls stored = as_stored(p, {{1, 2}});
  CHECK(stored.row(0) == p.row(0));
  for (Index k = 3; k < 9; ++k) CHECK(stored.data()[k] == static_cast<double>(static_cast<float>(p.data()[k])));
}

TEST_CASE("as_stored: invalid frames are named") {
  Controls p = Controls::Zero(4, 3);
  StorageFrame frame{1, 2};
  frame.frame(2, 2) = 0;
  CHECK_THROWS_WITH_AS(as_stored(p, {frame}), doctest::Contains("controls 1 to 2: the matrix is singular"), InputError);
  frame.frame = Eigen::Matrix4d::Identity();
  frame.frame(0, 3) = std::nan("");
  CHECK_THROWS_WITH_AS(as_stored(p, {frame}), doctest::Contains("not finite"), InputError);
  frame.frame = 2 * Eigen::Matrix4d::Identity();
  CHECK_THROWS_WITH_AS(as_stored(p, {frame}), doctest::Contains("not affine"), InputError);
  CHECK_THROWS_WITH_AS(as_stored(p, {{3, 2}}), doctest::Contains("there are 4 controls"), InputError);
  p(0, 0) = 1e39;
  CHECK_THROWS_WITH_AS(as_stored(p, {{0, 1}}), doctest::Contains("control 0 is too large"), InputError);
}

namespace {

Eigen::Matrix4d turned_frame() {
  Eigen::Matrix4d frame = Eigen::Matrix4d::Identity();
  frame.topLeftCorner<3, 3>() =
      Eigen::AngleAxisd(0.7, Vector3(1, 2, 3).normalized()).toRotationMatrix() * Vector3(2, -0.3, 1).asDiagonal();
  frame.topRightCorner<3, 1>() << 40, -7, 3;
  return frame;
}

/// The definition with rest positions as read from a file.
HandleDefinition read_from_storage(HandleDefinition definition, const Eigen::Matrix4d& frame) {
  definition.rest = as_stored(definition.rest, {{0, static_cast<Index>(definition.rest.rows()), frame}});
  return definition;
}

}  // namespace

TEST_CASE("stored mesh: the surface is the stored vertices, and the rest surface is exact") {
  const Eigen::Matrix4d frame = turned_frame();
  for (const bool hard : {true, false}) {
    const auto definition = read_from_storage(sheet_with_handles(7, hard, EdgeWeights::uniform), frame);
    for (const auto& mesh : {make_laplacian(definition), make_arap(definition)}) {
      const auto stored = make_stored_mesh(mesh, frame);
      CHECK(stored->surface(moved_handles(definition, 0)) == definition.rest);
      const Controls p = moved_handles(definition, 0.4);
      const Positions q = stored->surface(p);
      const Eigen::Affine3d to_world(frame), to_local = to_world.inverse();
      for (Index vertex = 0; vertex < q.rows(); ++vertex) {
        const Eigen::Vector3f local = (to_local * Vector3(mesh->surface(p).row(vertex))).cast<float>();
        CHECK((to_world * local.cast<double>() - Vector3(q.row(vertex))).norm() < 1e-13);
      }
      for (const Index vertex : definition.fixed) CHECK(q.row(vertex) == definition.rest.row(vertex));
    }
  }
}

TEST_CASE("stored mesh: responds as the mesh, and a following deformation acts on the stored vertices") {
  const Eigen::Matrix4d frame = turned_frame();
  const auto definition = read_from_storage(sheet_with_handles(5, true, EdgeWeights::uniform), frame);
  const auto mesh = make_laplacian(definition);
  const auto stored = make_stored_mesh(mesh, frame);
  const Controls p = moved_handles(definition, 0.3), d = random_positions(stored->control_count(), 5);
  CHECK(stored->push_forward(p, d) == mesh->push_forward(p, d));
  CHECK(stored->support(1) == mesh->support(1));
  const WeightMatrix weights = Eigen::MatrixXd(random_positions(9, stored->vertex_count()).leftCols(1) *
                                               Eigen::RowVectorXd::Ones(stored->vertex_count()))
                                   .sparseView();
  const auto chain = make_composition(make_linear(weights), stored);
  CHECK((chain->surface(p) - weights * stored->surface(p)).norm() < 1e-12 * chain->surface(p).norm());
}

TEST_CASE("stored mesh: a singular frame is refused") {
  const auto mesh = make_laplacian(sheet_with_handles(4, true, EdgeWeights::uniform));
  Eigen::Matrix4d frame = Eigen::Matrix4d::Identity();
  frame(1, 1) = 0;
  CHECK_THROWS_WITH_AS(make_stored_mesh(mesh, frame), doctest::Contains("singular"), InputError);
}
