// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/deformation/handles.hpp"

#include <Eigen/Geometry>

#include "deformation/handle_scenes.hpp"
#include "deformation/handles/handle_map.hpp"
#include "deformation/handles/mesh_laplacian.hpp"
#include "stiv/deformation/combination.hpp"

using namespace stiv;
using namespace stiv::testing;

namespace {

void for_all_kinds(const std::function<void(const HandleDefinition&)>& check) {
  for (const bool hard : {false, true})
    for (const EdgeWeights weights : {EdgeWeights::uniform, EdgeWeights::cotangent})
      check(sheet_with_handles(6, hard, weights));
}

/// J d against differences, and J' as the transpose of J. A surface is accurate to about 1e-9, so differences are
/// accurate to 1e-5.
void check_linearisation(const Deformation& deformation, const Controls& p) {
  constexpr double step = 1e-4;
  for (unsigned seed = 1; seed < 4; ++seed) {
    const Controls d = random_positions(static_cast<Index>(p.rows()), seed);
    const Positions velocity = (deformation.surface(p + step * d) - deformation.surface(p - step * d)) / (2 * step);
    const Positions found = deformation.push_forward(p, d);
    CHECK((found - velocity).norm() < 1e-4 * velocity.norm());
    const SparseField g = random_field(deformation.vertex_count(), 2, seed + 10);
    const double expected = dense(g, deformation.vertex_count()).cwiseProduct(found).sum();
    const Positions pulled = dense(deformation.pull_back(p, g), deformation.control_count());
    CHECK(pulled.cwiseProduct(d).sum() == doctest::Approx(expected).epsilon(1e-6));
  }
}

}  // namespace

TEST_CASE("arap: the linearisation, at rest and far from it") {
  for_all_kinds([](const HandleDefinition& definition) {
    const auto arap = make_arap(definition);
    for (const double amount : {0.0, 0.1, 0.7}) check_linearisation(*arap, moved_handles(definition, amount));
  });
}

TEST_CASE("arap: many covectors at once, by a factor of H, are pulled back as each alone, with any number of threads") {
  for_all_kinds([](const HandleDefinition& definition) {
    const auto arap = make_arap(definition);
    const Index n = arap->vertex_count(), m = arap->control_count();
    std::vector<SparseField> fields;
    for (unsigned seed = 0; seed < 20; ++seed)
      fields.push_back(random_field(n, 1 + static_cast<Index>(seed % 7), seed));
    for (const double amount : {0.0, 0.1, 0.7}) {
      const Controls p = moved_handles(definition, amount);
      const auto one = arap->pull_back_all(p, fields, Execution(1)), two = arap->pull_back_all(p, fields, Execution(2));
      for (std::size_t k = 0; k < fields.size(); ++k) {
        const Positions expected = dense(arap->pull_back(p, fields[k]), m);
        CHECK((dense(one[k], m) - expected).norm() < 1e-7 * expected.norm());
        CHECK(one[k].value == two[k].value);
      }
    }
  });
}

TEST_CASE("arap: rotations that do not answer would not do: the global step alone is far from J") {
  const HandleDefinition definition = sheet_with_handles(6, true, EdgeWeights::cotangent);
  const Surface mesh = checked_mesh(definition);
  const HandleMap frozen(definition, mesh, mesh_laplacian(edge_weights(mesh, definition.rest, EdgeWeights::cotangent)));
  const Controls p = moved_handles(definition, 0), d = random_positions(static_cast<Index>(p.rows()), 1);
  const Positions found = make_arap(definition)->push_forward(p, d);
  CHECK((frozen.follow(d) - found).norm() > 0.05 * found.norm());
}

TEST_CASE("arap: nothing moves at rest, and what is held never does") {
  for_all_kinds([](const HandleDefinition& definition) {
    const auto arap = make_arap(definition);
    CHECK(arap->surface(moved_handles(definition, 0)) == definition.rest);
    const Controls p = moved_handles(definition, 1);
    const Positions q = arap->surface(p);
    for (const Index vertex : definition.fixed) CHECK(q.row(vertex) == definition.rest.row(vertex));
    for (Index vertex = 36; vertex < 39; ++vertex) CHECK(q.row(vertex) == definition.rest.row(vertex));
    if (definition.pull.size() > 0) return;
    for (Index k = 0; k < p.rows(); ++k) CHECK(q.row(definition.handles[static_cast<std::size_t>(k)]) == p.row(k));
  });
}

TEST_CASE("arap: a rigid motion of all handles is one of the mesh") {
  for_all_kinds([](HandleDefinition definition) {
    definition.fixed.clear();
    const auto arap = make_arap(definition);
    for (const double angle : {0.3, 1.5, 2.9}) {
      const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, Vector3(1, 2, -0.5).normalized()).matrix();
      const auto moved = [&](const Positions& q) {
        return Positions((q * turn.transpose()).rowwise() + Eigen::RowVector3d(3, -1, 2));
      };
      const Positions q = arap->surface(moved(moved_handles(definition, 0)));
      CHECK((q - moved(definition.rest)).topRows(36).cwiseAbs().maxCoeff() < 1e-6);
    }
  });
}

TEST_CASE("arap: earlier surfaces do not matter") {
  const HandleDefinition definition = sheet_with_handles(6, false, EdgeWeights::cotangent);
  const auto one = make_arap(definition), other = make_arap(definition);
  const Controls p = moved_handles(definition, 0.5);
  other->surface(moved_handles(definition, 0.9));
  CHECK(one->surface(p) == other->surface(p));
}

TEST_CASE("arap: rows of the surface are near it, and do not depend on earlier surfaces") {
  for_all_kinds([](const HandleDefinition& definition) {
    const auto one = make_arap(definition), other = make_arap(definition);
    const Controls p = moved_handles(definition, 0.7);
    const std::vector<Index> rows{7, 0, 20};
    const Positions before = one->surface_rows(p, rows, Execution(1)), q = one->surface(p);
    CHECK(one->surface_rows(p, rows, Execution(1)) == before);
    CHECK(other->surface(p) == q);
    CHECK(other->surface_rows(p, rows, Execution(1)) == before);
    for (Index k = 0; k < 3; ++k) CHECK((before.row(k) - q.row(rows[static_cast<std::size_t>(k)])).norm() < 1e-3);
  });
}

TEST_CASE("arap: scale does not matter") {
  for_all_kinds([](const HandleDefinition& definition) {
    const Positions q = make_arap(definition)->surface(moved_handles(definition, 0.5));
    HandleDefinition small = definition;
    small.rest *= 1e-7;
    const Controls p = 1e-7 * moved_handles(definition, 0.5);
    CHECK((1e7 * make_arap(small)->surface(p) - q).cwiseAbs().maxCoeff() < 1e-6);
  });
}

TEST_CASE("arap: a linear deformation after it") {
  const HandleDefinition definition = sheet_with_handles(6, false, EdgeWeights::cotangent);
  const auto count = static_cast<Index>(definition.rest.rows());
  WeightMatrix weights(count, count);
  for (Index row = 0; row < count; ++row) {
    weights.insert(row, row) = 0.75;
    weights.coeffRef(row, (row + 1) % count) += 0.25;
  }
  check_linearisation(*make_composition(make_linear(weights), make_arap(definition)), moved_handles(definition, 0.4));
}

namespace {

/// The influence of each control by a row of J for each vertex.
Influence influence_by_rows(const Deformation& deformation, const Controls& p, const Eigen::VectorXd& distances) {
  Influence found{Eigen::VectorXd::Zero(p.rows()), Eigen::VectorXd::Zero(p.rows())};
  for (Index vertex = 0; vertex < deformation.vertex_count(); ++vertex) {
    const SparseField row = deformation.pull_back(p, {{vertex}, {Vector3::UnitX()}});
    for (std::size_t k = 0; k < row.index.size(); ++k) {
      const double motion = row.value[k].norm();
      if (!(motion > 0)) continue;
      found.largest[row.index[k]] = std::max(found.largest[row.index[k]], motion);
      found.miss[row.index[k]] = std::max(found.miss[row.index[k]], distances[vertex]);
    }
  }
  return found;
}

void check_influence(const Deformation& deformation, const Controls& p) {
  const Eigen::VectorXd distances = random_positions(deformation.vertex_count(), 31).col(0).cwiseAbs();
  const Influence expected = influence_by_rows(deformation, p, distances);
  const Influence one = deformation.influence(p, distances, Execution(1));
  const Influence two = deformation.influence(p, distances, Execution(2));
  CHECK((one.largest - expected.largest).norm() < 1e-7 * expected.largest.norm());
  CHECK(one.miss == expected.miss);
  CHECK(one.largest == two.largest);
  CHECK(one.miss == two.miss);
}

}  // namespace

TEST_CASE("arap: the influence of controls is that of a row for each vertex, with few controls and with many") {
  for (const Index side : {Index{6}, Index{12}})
    for (const bool hard : {false, true}) {
      const HandleDefinition definition = sheet_with_handles(side, hard, EdgeWeights::cotangent);
      const auto arap = make_arap(definition);
      for (const double amount : {0.0, 0.1, 0.7}) check_influence(*arap, moved_handles(definition, amount));
    }
}

TEST_CASE("arap: the influence of controls beside another component, and after a linear deformation") {
  const HandleDefinition definition = sheet_with_handles(12, true, EdgeWeights::cotangent);
  const auto arap = make_arap(definition);
  const Index n = arap->vertex_count(), m = arap->control_count();
  WeightMatrix halves(n - 1, n);
  for (Index row = 0; row + 1 < n; ++row) {
    halves.insert(row, row) = 0.5;
    halves.insert(row, row + 1) = 0.5;
  }
  check_influence(*make_composition(make_linear(halves), arap), moved_handles(definition, 0.3));
  std::vector<Index> last_first;
  for (Index vertex = 0; vertex < n; ++vertex) last_first.push_back(n + 1 - vertex);
  const auto whole = make_concatenation({{make_identity(2), {0, 1}}, {arap, last_first}}, random_positions(n + 2, 3));
  Controls p(m + 2, 3);
  p << random_positions(2, 4), moved_handles(definition, 0.3);
  check_influence(*whole, p);
}
