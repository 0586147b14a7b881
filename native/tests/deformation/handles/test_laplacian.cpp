// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/handle_scenes.hpp"
#include "stiv/deformation/combination.hpp"
#include "stiv/deformation/handles.hpp"
#include "stiv/error.hpp"

using namespace stiv;
using namespace stiv::testing;

namespace {

void for_all_kinds(const std::function<void(const HandleDefinition&)>& check) {
  for (const bool hard : {false, true})
    for (const EdgeWeights weights : {EdgeWeights::uniform, EdgeWeights::cotangent})
      check(sheet_with_handles(6, hard, weights));
}

/// Every vertex of a mesh, and one between each pair of consecutive ones.
std::shared_ptr<const LinearDeformation> refinement(Index count) {
  std::vector<Eigen::Triplet<double, Index>> entries;
  for (Index row = 0; row < 2 * count - 1; ++row) {
    entries.emplace_back(row, row / 2, 0.5);
    entries.emplace_back(row, (row + 1) / 2, 0.5);
  }
  WeightMatrix weights(2 * count - 1, count);
  weights.setFromTriplets(entries.begin(), entries.end());
  return make_linear(weights);
}

void check_handle_metric(const Deformation& deformation, const Controls& p) {
  MetricOptions options;
  check_metric(deformation, p, options, mean_damping(deformation, p, options));
  options.smoothness = 0.01;
  options.weights = Eigen::VectorXd::LinSpaced(p.rows(), 0, 2);
  check_metric(deformation, p, options, mean_damping(deformation, p, options));
  for (const bool turned : {false, true}) {
    options = random_axis_weights(static_cast<Index>(p.rows()), 5, turned);
    check_metric(deformation, p, options, mean_damping(deformation, p, options));
  }
}

}  // namespace

TEST_CASE("laplacian: derivatives and metric") {
  for_all_kinds([](const HandleDefinition& definition) {
    const auto laplacian = make_laplacian(definition);
    const Controls p = moved_handles(definition, 1);
    check_derivatives(*laplacian, p);
    check_handle_metric(*laplacian, p);
  });
}

TEST_CASE("laplacian: the rest surface is exact, and fixed vertices never move") {
  for_all_kinds([](const HandleDefinition& definition) {
    const auto laplacian = make_laplacian(definition);
    CHECK(laplacian->surface(moved_handles(definition, 0)) == definition.rest);
    const Controls p = moved_handles(definition, 3);
    const Positions q = laplacian->surface(p);
    for (const Index vertex : definition.fixed) CHECK(q.row(vertex) == definition.rest.row(vertex));
    for (Index vertex = 36; vertex < 39; ++vertex) CHECK(q.row(vertex) == definition.rest.row(vertex));
    for (Index k = 0; k + 1 < p.rows(); ++k)  // except the last one, which is in no triangle
      CHECK((q.row(definition.handles[static_cast<std::size_t>(k)]) == p.row(k)) == (definition.pull.size() == 0));
  });
}

TEST_CASE("laplacian: the surface minimises the sum of squares") {
  for_all_kinds([](const HandleDefinition& definition) {
    if (definition.edge_weights == EdgeWeights::cotangent || definition.pull.size() == 0) return;
    const auto neighbours = [&](Index vertex) {
      std::vector<unsigned char> near(static_cast<std::size_t>(definition.rest.rows()), 0);
      for (Index face = 0; face < definition.triangles.rows(); ++face)
        if ((definition.triangles.row(face).array() == vertex).any())
          for (Index k = 0; k < 3; ++k) near[static_cast<std::size_t>(definition.triangles(face, k))] = 1;
      near[static_cast<std::size_t>(vertex)] = 0;
      return near;
    };
    const Controls p = moved_handles(definition, 1);
    const auto sum_of_squares = [&](const Positions& q) {
      const Positions u = q - definition.rest;
      double sum = 0;
      for (Index vertex = 0; vertex < u.rows(); ++vertex) {
        Vector3 mean = Vector3::Zero();
        double count = 0;
        const auto near = neighbours(vertex);
        for (Index other = 0; other < u.rows(); ++other)
          if (near[static_cast<std::size_t>(other)] != 0) mean += u.row(other).transpose(), ++count;
        if (count > 0) sum += (u.row(vertex).transpose() - mean / count).squaredNorm();
      }
      for (std::size_t k = 0; k < definition.handles.size(); ++k) {
        const auto row = static_cast<Index>(k);
        sum += definition.pull[row] * (q.row(definition.handles[k]) - p.row(row)).squaredNorm();
      }
      return sum;
    };
    const Positions q = make_laplacian(definition)->surface(p);
    const double least = sum_of_squares(q);
    for (Index vertex = 6; vertex < 36; vertex += 7)
      for (const double step : {-1e-3, 1e-3}) {
        Positions other = q;
        other(vertex, vertex % 3) += step;
        CHECK(sum_of_squares(other) > least);
      }
  });
}

TEST_CASE("laplacian: followed by a linear deformation") {
  for_all_kinds([](const HandleDefinition& definition) {
    const Controls p = moved_handles(definition, 1);
    const auto outer = refinement(static_cast<Index>(definition.rest.rows()));
    const auto chain = make_composition(outer, make_laplacian(definition));
    CHECK(chain->surface(p) == outer->surface(make_laplacian(definition)->surface(p)));
    check_derivatives(*chain, p);
    check_handle_metric(*chain, p);
    const auto twice = make_composition(refinement(chain->vertex_count()), chain);
    check_derivatives(*twice, p);
    check_handle_metric(*twice, p);
  });
  const auto laplacian = make_laplacian(sheet_with_handles(6, true, EdgeWeights::uniform));
  CHECK_THROWS_WITH_AS(make_composition(refinement(7), laplacian), doctest::Contains("7 controls"), InputError);
}

TEST_CASE("laplacian: slivers and triangles without area have finite weights") {
  HandleDefinition definition = sheet_with_handles(6, false, EdgeWeights::cotangent);
  definition.rest.row(8) = definition.rest.row(9);
  definition.rest.row(14) = (definition.rest.row(13) + definition.rest.row(15)) / 2;
  const Controls p = moved_handles(definition, 1);
  const Positions q = make_laplacian(definition)->surface(p);
  CHECK(q.allFinite());
  CHECK((q - definition.rest).cwiseAbs().maxCoeff() < 10);
}

TEST_CASE("laplacian: independent of scale") {
  for_all_kinds([](const HandleDefinition& definition) {
    const Positions q = make_laplacian(definition)->surface(moved_handles(definition, 1));
    HandleDefinition small = definition;
    small.rest *= 1e-7;
    const Controls p = 1e-7 * moved_handles(definition, 1);
    CHECK((1e7 * make_laplacian(small)->surface(p) - q).cwiseAbs().maxCoeff() < 1e-9);
  });
}

TEST_CASE("laplacian: invalid input is named") {
  const HandleDefinition good = sheet_with_handles(6, false, EdgeWeights::uniform);
  const auto refused = [](const HandleDefinition& definition, const char* message) {
    CHECK_THROWS_WITH_AS(make_laplacian(definition), doctest::Contains(message), InputError);
  };
  HandleDefinition bad = good;
  bad.handles[1] = bad.handles[0];
  refused(bad, "handle 1: vertex 35 is already handle 0");
  bad = good;
  bad.handles[2] = 40;
  refused(bad, "handle 2: vertex 40 does not exist");
  bad = good;
  bad.fixed.push_back(35);
  refused(bad, "vertex 35 is handle 0");
  bad = good;
  bad.pull[2] = 0;
  refused(bad, "handle 2: its pull");
  bad = good;
  bad.pull.conservativeResize(2);
  refused(bad, "but 2 pulls");
  bad = good;
  bad.rest(4, 1) = NAN;
  refused(bad, "rest position of vertex 4");
  bad = good;
  bad.triangles(3, 1) = 77;
  refused(bad, "77");
}
