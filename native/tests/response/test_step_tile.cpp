// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <random>

#include "response/sparse_fields.hpp"
#include "response/step_tile.hpp"
#include "vector_targets.hpp"

using namespace stiv;

namespace {

SparseField some_field(Index controls, double probability, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  SparseField field;
  for (Index k = 0; k < controls; ++k) {
    if (unit(random) > probability) continue;
    field.index.push_back(k);
    field.value.push_back(Vector3(unit(random), -unit(random), unit(random) - 0.5));
  }
  return field;
}

}  // namespace

TEST_CASE("step tile: products are those of rows and steps, the same bits for every vector target") {
  std::mt19937 random(5);
  for (const Index count : {1, 7, 31, 32}) {
    std::vector<ControlConstraint> constraints;
    for (Index k = 0; k < count; ++k)
      constraints.push_back({some_field(60, 0.2, random), some_field(80, k % 2 == 0 ? 1.0 : 0.3, random), 0});
    const RowControls controls(constraints);
    const StepTile tile(constraints, controls);
    for (const ControlConstraint& constraint : constraints) {
      const auto results = for_each_vector_target([&] {
        StepTile::Products products;
        tile.multiply(constraint.row, products);
        return products;
      });
      for (const StepTile::Products& products : results) CHECK(products == results.front());
      for (std::size_t lane = 0; lane < StepTile::width; ++lane) {
        const double expected = lane < constraints.size() ? dot(constraint.row, constraints[lane].step) : 0;
        CHECK(results.front()[lane] == doctest::Approx(expected).epsilon(1e-12));
      }
    }
  }
}
