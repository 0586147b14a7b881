// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/handles/truncated_map.hpp"

#include "deformation/handle_scenes.hpp"
#include "deformation/handles/handle_map.hpp"
#include "deformation/handles/mesh_laplacian.hpp"

using namespace stiv;
using namespace stiv::testing;

namespace {

constexpr Index side = 30;

/// A sheet whose handles are every third vertex of every third row, and the others of `sheet_with_handles`.
HandleDefinition scattered_handles(bool hard) {
  HandleDefinition definition = sheet_with_handles(side, hard, EdgeWeights::uniform);
  for (Index i = 2; i + 3 < side; i += 3)
    for (Index j = 1; j < side; j += 3)
      if (i * side + j != definition.handles[definition.handles.size() - 2]) definition.handles.push_back(i * side + j);
  if (!hard) definition.pull = Eigen::VectorXd::LinSpaced(static_cast<Index>(definition.handles.size()), 0.5, 3);
  return definition;
}

SymmetricMatrix stiffness_of(const HandleDefinition& definition) {
  return squared_laplacian(edge_weights(checked_mesh(definition), definition.rest, definition.edge_weights));
}

HandleMap map_of(const HandleDefinition& definition, const HandleMapLimits& limits) {
  return {definition, checked_mesh(definition), stiffness_of(definition), limits};
}

/// Limits too low for M in full and for the columns of K^-1 that M'g reads.
HandleMapLimits truncating(const HandleDefinition& definition) {
  HandleMapLimits limits;
  const auto free = static_cast<double>(definition.rest.rows()) - 2 * side;
  limits.entries = free * static_cast<double>(definition.handles.size());
  limits.negligible = 1e-3;
  limits.density = 1;
  return limits;
}

Eigen::MatrixXd dense_map(const HandleDefinition& definition) {
  const HandleMap full = map_of(definition, {});
  Eigen::MatrixXd map(full.vertex_count(), full.control_count());
  for (Index k = 0; k < full.control_count(); ++k) {
    Controls d = Controls::Zero(full.control_count(), 3);
    d(k, 0) = 1;
    map.col(k) = full.follow(d).col(0);
  }
  return map;
}

}  // namespace

TEST_CASE("truncated map: M'g and the diagonal of the metric are those of M, but for what is negligible") {
  for (const bool hard : {false, true}) {
    const HandleDefinition definition = scattered_handles(hard);
    const HandleMap truncated = map_of(definition, truncating(definition));
    REQUIRE(truncated.is_truncated());
    const Eigen::MatrixXd map = dense_map(definition);
    const auto m = static_cast<Index>(map.cols()), n = static_cast<Index>(map.rows());
    std::vector<SparseField> fields;
    for (unsigned seed = 0; seed < 20; ++seed) fields.push_back(random_field(n, 5, seed));
    fields.emplace_back();
    const std::vector<SparseField> pulled = truncated.pull_back_all(fields, Execution(1));
    for (std::size_t k = 0; k < fields.size(); ++k) {
      CHECK((dense(pulled[k], m) - map.transpose() * dense(fields[k], n)).cwiseAbs().maxCoeff() < 0.01);
      CHECK(pulled[k].index.size() < static_cast<std::size_t>(m));
      CHECK(truncated.pull_back_all(fields, Execution(2))[k].value == pulled[k].value);
      CHECK(truncated.pull_back(fields[k]).value == pulled[k].value);
    }
    WeightMatrix gram(n, n);
    gram.setIdentity();
    for (Index k = 0; k + 1 < n; ++k) gram.coeffRef(k, k + 1) = gram.coeffRef(k + 1, k) = 0.4;
    MetricOptions options;
    options.weights = Eigen::VectorXd::LinSpaced(m, 0, 2);
    for (const WeightMatrix* surface_gram : {static_cast<const WeightMatrix*>(nullptr), &std::as_const(gram)}) {
      Eigen::VectorXd diagonal = (map.transpose() * map).diagonal();
      if (surface_gram != nullptr) diagonal = (map.transpose() * (gram * map)).diagonal();
      const auto metric = truncated.metric(options, surface_gram);
      const double damping = options.smoothness * diagonal.tail(m - 1).mean();
      for (const Index k : {Index{0}, m / 2, m - 1}) {
        const SparseField step = metric->apply_inverse(Controls(), {{k}, {Vector3::UnitY()}});
        const double expected = options.weights[k] / (diagonal[k] + damping);
        CHECK(dense(step, m)(k, 1) == doctest::Approx(expected).epsilon(1e-4));
      }
    }
  }
}

TEST_CASE("truncated map: entries are those of the dense map, the finer the closer; too many are refused") {
  for (const bool hard : {false, true}) {
    const HandleDefinition definition = scattered_handles(hard);
    const HandlePartition partition = handle_partition(definition, checked_mesh(definition));
    const HandleMap whole = map_of(definition, {});
    const Eigen::MatrixXd expected = dense_map(definition);
    double entries = 0;
    for (const double negligible : {1e-2, 1e-6}) {
      const auto found = truncated_map(whole.factor(), whole.drive(), partition, negligible, 1e9);
      REQUIRE(found.has_value());
      CHECK((Eigen::MatrixXd(*found) - expected).cwiseAbs().maxCoeff() < 1.5 * negligible);
      CHECK(static_cast<double>(found->nonZeros()) > entries);
      entries = static_cast<double>(found->nonZeros());
      CHECK_FALSE(truncated_map(whole.factor(), whole.drive(), partition, negligible, entries / 2).has_value());
    }
  }
}
