// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include "stiv/vector_target.hpp"
#include "vector_targets.hpp"

using namespace stiv;

TEST_CASE("vector target: a limit holds, and none goes above what the machine has") {
  const VectorTarget before = vector_target();
  limit_vector_target(VectorTarget::avx512);
  CHECK(vector_target() == best_vector_target());
  limit_vector_target(VectorTarget::baseline);
  CHECK(vector_target() == VectorTarget::baseline);
  limit_vector_target(before);
  CHECK(vector_target() == before);
}

TEST_CASE("vector target: each one that the machine has is tried once") {
  const auto tried = for_each_vector_target([] { return vector_target(); });
  REQUIRE(tried.size() == static_cast<std::size_t>(best_vector_target()) + 1);
  for (std::size_t k = 0; k < tried.size(); ++k) CHECK(static_cast<std::size_t>(tried[k]) == k);
}
