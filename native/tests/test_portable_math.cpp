// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <Eigen/Cholesky>
#include <Eigen/SVD>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "portable_math.hpp"
#include "stiv/types.hpp"

using namespace stiv;

namespace {

struct Numbers {
  std::uint64_t state = 1;

  /// In [-1, 1), 53 bits. [SplitMix64]
  double next() {
    std::uint64_t z = (state += 0x9E3779B97F4A7C15U);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
    return std::ldexp(static_cast<double>((z ^ (z >> 31)) >> 11), -52) - 1;
  }
};

/// FNV-1a over the bits of numbers.
struct Hash {
  std::uint64_t value = 0xCBF29CE484222325U;

  void add(double x) { value = (value ^ std::bit_cast<std::uint64_t>(x)) * 0x100000001B3U; }
};

Eigen::MatrixXd random_matrix(Index rows, Index columns) {
  Numbers numbers;
  Eigen::MatrixXd matrix(rows, columns);
  for (double& x : matrix.reshaped()) x = numbers.next();
  return matrix;
}

}  // namespace

TEST_CASE("portable math: every result is the nearest double, as computed by MPFR") {
  Numbers numbers;
  Hash sines, cosines, angles;
  for (int k = 0; k < 20000; ++k) {
    const double x = numbers.next() * std::ldexp(1.0, k % 32 - 8);
    const double y = numbers.next() * std::ldexp(1.0, k % 40 - 20);
    sines.add(portable_sin(x));
    cosines.add(portable_cos(x));
    angles.add(portable_atan2(y, numbers.next()));
  }
  CHECK(sines.value == 0xC22EDBA89761F022U);
  CHECK(cosines.value == 0xDDE4CCD8BB4404F0U);
  CHECK(angles.value == 0x9A914061102345F1U);
}

TEST_CASE("portable math: special arguments") {
  const double pi = std::numbers::pi, infinity = std::numeric_limits<double>::infinity();
  CHECK(portable_sin(0) == 0);
  CHECK(portable_cos(0) == 1);
  CHECK(portable_atan2(0, 1) == 0);
  CHECK(portable_atan2(1, 0) == pi / 2);
  CHECK(portable_atan2(-1, 0) == -pi / 2);
  CHECK(portable_atan2(0, -1) == pi);
  CHECK(portable_atan2(-0.0, -1) == -pi);
  CHECK(portable_atan2(0, 0) == 0);
  CHECK(portable_atan2(1e-300, 1e300) == 0);
  CHECK(portable_atan2(3e-310, 3e-310) == pi / 4);
  CHECK(std::isnan(portable_sin(infinity)));
  CHECK(std::isnan(portable_cos(-infinity)));
  for (const double x : {1e9, 1e300}) {
    const double s = portable_sin(x), c = portable_cos(x);
    CHECK(s * s + c * c == doctest::Approx(1).epsilon(1e-15));
  }
}

TEST_CASE("portable math: dense algebra has the same bits on every processor") {
  const Eigen::MatrixXd matrix = random_matrix(1500, 77);
  const Eigen::MatrixXd gram = matrix.transpose() * matrix;
  const Eigen::MatrixXd solution = gram.llt().solve(matrix.topRows(77));
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix.topLeftCorner<3, 3>(), Eigen::ComputeFullU | Eigen::ComputeFullV);
  Hash hash;
  for (const double x : gram.reshaped()) hash.add(x);
  for (const double x : solution.reshaped()) hash.add(x);
  for (const double x : svd.matrixU().reshaped()) hash.add(x);
  CHECK(hash.value == 0x6A5FF219AF4B8036U);
  CHECK(Eigen::l1CacheSize() == 48 << 10);
}
