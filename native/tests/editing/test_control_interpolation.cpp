// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "editing/control_interpolation.hpp"

using namespace stiv;

namespace {

constexpr double pi = 3.14159265358979323846;

Controls placement(const Vector3& centre, const Vector3& rotation) {
  Controls p(2, 3);
  p << centre.transpose(), rotation.transpose();
  return p;
}

/// Rotation matrix of a rotation vector by its power series: independent of quaternions.
Eigen::Matrix3d matrix(const Vector3& v) {
  Eigen::Matrix3d K, power = Eigen::Matrix3d::Identity(), sum = power;
  K << 0, -v[2], v[1], v[2], 0, -v[0], -v[1], v[0], 0;
  for (int k = 1; k < 40; ++k) {
    power = power * K / k;
    sum += power;
  }
  return sum;
}

}  // namespace

TEST_CASE("goal: points are interpolated and end exactly") {
  const Controls from = Controls::Random(5, 3), to = Controls::Random(5, 3);
  CHECK(interpolate(from, to, 1, {}) == to);
  CHECK(interpolate(from, to, 0, {}) == from);
  CHECK((interpolate(from, to, 0.25, {}) - (0.75 * from + 0.25 * to)).norm() < 1e-15);
}

TEST_CASE("goal: a rotation is interpolated about one axis") {
  std::srand(2);
  for (int trial = 0; trial < 50; ++trial) {
    const Controls from = placement(Vector3::Random(), 2 * Vector3::Random());
    const Controls to = placement(Vector3::Random(), 2 * Vector3::Random());
    const Controls half = interpolate(from, to, 0.5, {1});
    const Eigen::Matrix3d start = matrix(from.row(1)), middle = matrix(half.row(1)), end = matrix(to.row(1));
    CHECK((middle * start.transpose() * middle - end).norm() < 1e-12);  // the same rotation twice
    const double cosine = ((end * start.transpose()).trace() - 1) / 2;
    CHECK(std::cos(largest_rotation(from, to, {1})) == doctest::Approx(cosine));
    CHECK(std::cos(largest_rotation(from, half, {1})) == doctest::Approx(std::sqrt((1 + cosine) / 2)));
  }
}

TEST_CASE("goal: increments of rotations are composed, those of points are added") {
  std::srand(4);
  for (int trial = 0; trial < 50; ++trial) {
    const Controls base = placement(Vector3::Random(), Vector3::Random());
    const Controls from = placement(Vector3::Random(), Vector3::Random());
    const Controls to = placement(Vector3::Random(), Vector3::Random());
    const Controls moved = moved_alike(base, from, to, {1});
    CHECK((moved.row(0) - (base.row(0) + to.row(0) - from.row(0))).norm() < 1e-15);
    const Eigen::Matrix3d turn = matrix(to.row(1)) * matrix(from.row(1)).transpose();
    CHECK((matrix(moved.row(1)) - turn * matrix(base.row(1))).norm() < 1e-12);
  }
}

TEST_CASE("goal: without rotation, the rotation vector does not change at all, even beyond half a turn") {
  const Controls base = placement(Vector3::Zero(), Vector3(0, 0, 1.5 * pi));
  const Controls from = placement(Vector3::Zero(), Vector3(0.1, 0.2, 0.3));
  CHECK(moved_alike(base, from, placement(Vector3::Ones(), from.row(1)), {1}).row(1) == base.row(1));
}
