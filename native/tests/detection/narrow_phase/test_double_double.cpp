// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <random>

#include "detection/narrow_phase/double_double.hpp"

using namespace stiv;

namespace {

/// Numbers of 53 bits whose sums and products fit into the 113 bits of the reference, or nearly.
#ifdef __SIZEOF_FLOAT128__
using Wide = __float128;
#else
using Wide = long double;  // arm64: 113 bits too
#endif

Wide wide(const DoubleDouble& a) { return Wide(a.high) + Wide(a.low); }

double relative_error(const DoubleDouble& found, Wide truth) {
  if (truth == 0) return found.high == 0 && found.low == 0 ? 0 : 1;
  const Wide error = (wide(found) - truth) / truth;
  return static_cast<double>(error < 0 ? -error : error);
}

}  // namespace

TEST_CASE("double-double: every operation errs by less than the bound that the narrow phase assumes") {
  std::mt19937_64 random(23);
  std::uniform_real_distribution<double> number(-1, 1);
  std::uniform_int_distribution<int> exponent(-30, 30);
  const auto make = [&] {
    const double high = std::ldexp(number(random), exponent(random));
    return DoubleDouble(high) + DoubleDouble(high * number(random) * 0x1p-53);
  };
  constexpr double bound = 0x1p-102;
  for (int trial = 0; trial < 20000; ++trial) {
    const DoubleDouble a = make(), b = make();
    CHECK(relative_error(a + b, wide(a) + wide(b)) < bound);
    CHECK(relative_error(a - b, wide(a) - wide(b)) < bound);
    CHECK(relative_error(a * b, wide(a) * wide(b)) < bound);
    CHECK(relative_error(a / b, wide(a) / wide(b)) < bound);
    const DoubleDouble root = sqrt(abs(a));
    CHECK(relative_error(root * root, wide(abs(a))) < 4 * bound);
    CHECK((a < b) == (wide(a) < wide(b)));
  }
}

TEST_CASE("double-double: the difference of two doubles is exact") {
  CHECK(DoubleDouble(1.0) - DoubleDouble(0x1p-80) == DoubleDouble(1.0, -0x1p-80));
  CHECK(sqrt(DoubleDouble(0.0)) == DoubleDouble(0.0));
}
