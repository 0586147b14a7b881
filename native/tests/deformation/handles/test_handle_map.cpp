// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/handles/handle_map.hpp"

#include "deformation/handle_scenes.hpp"
#include "deformation/handles/mesh_laplacian.hpp"
#include "deformation/metric/gram_metric.hpp"
#include "stiv/error.hpp"

using namespace stiv;
using namespace stiv::testing;

namespace {

HandleMap map_of(const HandleDefinition& definition, const HandleMapLimits& limits) {
  const Surface mesh = checked_mesh(definition);
  return {definition, mesh, squared_laplacian(edge_weights(mesh, definition.rest, definition.edge_weights)), limits};
}

WeightMatrix twice_unit(Index count) {
  WeightMatrix matrix(count, count);
  matrix.setIdentity();
  return 2 * matrix;
}

}  // namespace

TEST_CASE("handle map: the stored map equals the solved one") {
  for (const bool hard : {false, true}) {
    const HandleDefinition definition = sheet_with_handles(9, hard, EdgeWeights::uniform);
    const HandleMap full = map_of(definition, {}), solved = map_of(definition, {0, 0, 32});
    const Index m = full.control_count(), n = full.vertex_count();
    const Controls d = random_positions(m, 1);
    CHECK((full.follow(d) - solved.follow(d)).norm() < 1e-10 * full.follow(d).norm());
    const SparseField g = random_field(n, 3, 2);
    CHECK((dense(full.pull_back(g), m) - dense(solved.pull_back(g), m)).norm() < 1e-10);
    // With more probes than controls the approximation is exact.
    MetricOptions options;
    options.weights = Eigen::VectorXd::LinSpaced(m, 0, 2);
    const SparseField covector = random_field(m, 1, 3);
    const WeightMatrix gram = twice_unit(n);
    for (const WeightMatrix* surface_gram : {static_cast<const WeightMatrix*>(nullptr), &gram}) {
      const auto step = [&](const HandleMap& map) {
        return dense(map.metric(options, surface_gram)->apply_inverse(Controls(), covector), m);
      };
      CHECK((step(full) - step(solved)).norm() < 1e-6 * step(full).norm());
      options = random_axis_weights(m, 6, false);
      CHECK((step(full) - step(solved)).norm() < 1e-6 * step(full).norm());
    }
  }
}

TEST_CASE("handle map: adjacent handles need the columns of the inverse at their boundary only") {
  constexpr Index side = 17;
  for (const bool hard : {false, true}) {
    HandleDefinition definition = sheet_with_handles(side, hard, EdgeWeights::uniform);
    definition.handles.clear();
    for (Index i = 3; i < side - 3; ++i)
      for (Index j = 3; j < side - 3; ++j) definition.handles.push_back(i * side + j);
    const auto m = static_cast<Index>(definition.handles.size());
    if (!hard) definition.pull = Eigen::VectorXd::LinSpaced(m, 0.2, 3);
    const HandleMap solved = map_of(definition, {0, 0, 32});
    const double entries = static_cast<double>(m) * solved.vertex_count();
    const HandleMap kept = map_of(definition, {entries - 1, 0, 32});
    CHECK(kept.has_cached_columns());
    CHECK_FALSE(solved.has_cached_columns());
    for (unsigned seed = 0; seed < 5; ++seed) {
      const SparseField g = random_field(kept.vertex_count(), 3, seed);
      CHECK((dense(kept.pull_back(g), m) - dense(solved.pull_back(g), m)).norm() < 1e-10);
    }
  }
}

TEST_CASE("handle map: many covectors give the bits of single ones, for any number of threads") {
  for (const bool hard : {false, true}) {
    const HandleDefinition definition = sheet_with_handles(9, hard, EdgeWeights::uniform);
    std::vector<SparseField> fields;
    for (unsigned seed = 0; seed < 40; ++seed) {
      fields.push_back(
          random_field(static_cast<Index>(definition.rest.rows()), 1 + static_cast<Index>(seed % 5), seed));
      const Vector3 direction = Vector3(1, 2, -2) / 3;  // of a contact: one for all of its vertices
      if (seed % 3 != 0)
        for (Vector3& value : fields.back().value) value = value[0] * direction;
    }
    fields.emplace_back();
    for (const HandleMapLimits& limits : {HandleMapLimits{}, HandleMapLimits{0, 0, 32}}) {
      const HandleMap map = map_of(definition, limits);
      for (const int threads : {1, 2}) {
        const auto all = map.pull_back_all(fields, Execution(threads));
        REQUIRE(all.size() == fields.size());
        for (std::size_t k = 0; k < fields.size(); ++k) {
          const SparseField alone = map.pull_back(fields[k]);
          CHECK(all[k].index == alone.index);
          CHECK(all[k].value == alone.value);
        }
      }
    }
  }
}

TEST_CASE("handle map: the solution of a load minimises its energy") {
  const HandleDefinition definition = sheet_with_handles(6, false, EdgeWeights::cotangent);
  const Surface mesh = checked_mesh(definition);
  const SymmetricMatrix stiffness = mesh_laplacian(edge_weights(mesh, definition.rest, definition.edge_weights));
  const HandleMap map(definition, mesh, stiffness);
  const Positions load = random_positions(map.vertex_count(), 4), u = map.solve(load);
  Positions residual = stiffness * u - load;
  for (std::size_t k = 0; k < definition.handles.size(); ++k)
    residual.row(definition.handles[k]) += definition.pull[static_cast<Index>(k)] * u.row(definition.handles[k]);
  for (const Index vertex : map.partition().free) CHECK(residual.row(vertex).norm() < 1e-10);
}

TEST_CASE("low-rank metric: few probes determine a decaying spectrum") {
  constexpr Index count = 200;
  const Eigen::MatrixXd noise = Eigen::MatrixXd::NullaryExpr(count, count, [](Eigen::Index row, Eigen::Index column) {
    return std::sin(1.7 * static_cast<double>(row * count + column) * static_cast<double>(row + 1));
  });
  const Eigen::MatrixXd basis = noise.householderQr().householderQ();
  Eigen::VectorXd values(count);
  for (Index k = 0; k < count; ++k) values[k] = 0.2 + 500 * std::exp(-0.4 * k);
  const Eigen::MatrixXd gram = basis * values.asDiagonal() * basis.transpose();
  const auto product = [&](const ColumnBlock& block) { return ColumnBlock(gram * block); };
  const auto active = active_controls(Eigen::VectorXd::Ones(count), Eigen::VectorXd::Ones(count));
  const SparseField g = random_field(count, 2, 5);
  const auto exact = make_gram_metric(gram, 0.1, active), found = make_low_rank_metric(product, 64, 0.1, active);
  const Positions a = dense(exact->apply_inverse(Controls(), g), count);
  CHECK((a - dense(found->apply_inverse(Controls(), g), count)).norm() < 0.1 * a.norm());
}

TEST_CASE("sparse factor: sixteen right-hand sides have the bits of three, and solve the system") {
  SymmetricMatrix matrix(50, 50);
  std::vector<Eigen::Triplet<double, Index>> entries;
  for (Index k = 0; k < 50; ++k) {
    entries.emplace_back(k, k, 6 + 0.1 * k);
    for (const Index other : {(k + 1) % 50, (k + 7) % 50}) {
      entries.emplace_back(k, other, -1);
      entries.emplace_back(other, k, -1);
    }
  }
  matrix.setFromTriplets(entries.begin(), entries.end());
  const SparseFactor factor(matrix, "test");
  const Positions three = random_positions(50, 6);
  ColumnBlock sixteen = ColumnBlock::Random(50, 16);
  sixteen.middleCols<3>(5) = three;
  const Positions x = factor.solve(three);
  CHECK((matrix * x - three).norm() < 1e-12);
  CHECK(factor.solve(sixteen).middleCols<3>(5) == x);
  matrix.coeffRef(20, 20) = -1;
  CHECK_THROWS_WITH_AS(SparseFactor(matrix, "test"), "test", InputError);
}
