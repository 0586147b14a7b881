// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/finite_differences.hpp"
#include "stiv/deformation/subdivision.hpp"
#include "stiv/error.hpp"

using namespace stiv;
using namespace stiv::testing;

namespace {

/// A quad, an adjacent triangle, and a chain of two loose edges from the triangle's apex.
Cage mixed_cage() {
  Cage cage;
  cage.vertex_count = 7;
  cage.edges.resize(8, 2);
  cage.edges << 0, 1, 1, 2, 2, 3, 3, 0, 1, 4, 4, 2, 4, 5, 6, 5;
  cage.face_corners = {0, 1, 2, 3, 1, 4, 2};
  cage.face_starts = {0, 4, 7};
  cage.edge_crease = {0, 1, 0, 0, 0.5, 0, 0, 0};
  cage.vertex_crease = {0, 0, 0.7F, 0, 0, 0, 0};
  return cage;
}

std::vector<SubdivisionOptions> all_options() {
  std::vector<SubdivisionOptions> all;
  for (const int levels : {0, 1, 2, 4})
    for (const bool limit : {true, false})
      for (const bool simple : {true, false}) all.push_back({levels, limit, 3, simple, BoundarySmoothing::all});
  all.push_back({2, true, 1, false, BoundarySmoothing::preserve_corners});
  return all;
}

}  // namespace

TEST_CASE("subdivision: weights sum to 1, with Blender's number of vertices") {
  for (const SubdivisionOptions& options : all_options()) {
    const WeightMatrix weights = subdivision_weights(mixed_cage(), options);
    const Index cuts = 1 << options.levels, half = cuts / 2;
    const Index inner = options.levels == 0 ? 0 : (cuts - 1) * (cuts - 1) + 1 + 3 * half * (half - 1);
    CHECK(weights.rows() == 7 + 8 * (cuts - 1) + inner);
    CHECK((weights * Eigen::VectorXd::Ones(7) - Eigen::VectorXd::Ones(weights.rows())).cwiseAbs().maxCoeff() < 1e-12);
  }
}

TEST_CASE("subdivision: Simple preserves vertices and halves edges") {
  const WeightMatrix weights = subdivision_weights(mixed_cage(), {1, true, 3, true, BoundarySmoothing::all});
  const Eigen::MatrixXd dense_weights = weights;
  CHECK((dense_weights.topRows(7) - Eigen::MatrixXd::Identity(7, 7)).norm() < 1e-12);
  const Cage cage = mixed_cage();
  for (Index edge = 0; edge < 8; ++edge)
    for (Index end = 0; end < 2; ++end) CHECK(dense_weights(7 + edge, cage.edges(edge, end)) == doctest::Approx(0.5));
}

TEST_CASE("subdivision: a chain of loose edges is a cubic B-spline, linear at its ends") {
  Cage chain;
  chain.vertex_count = 3;
  chain.edges.resize(2, 2);
  chain.edges << 0, 1, 2, 1;
  const Eigen::MatrixXd weights = subdivision_weights(chain, {1, true, 3, false, BoundarySmoothing::all});
  CHECK(weights.row(0).isApprox(Eigen::RowVector3d(1, 0, 0)));
  CHECK(weights.row(1).isApprox(Eigen::RowVector3d(1, 4, 1) / 6));
  // At 1/2 the spline has the weights (1, 23, 23, 1) / 48; the point before the first is 2 p0 - p1.
  CHECK(weights.row(3).isApprox(Eigen::RowVector3d(25, 22, 1) / 48));
  CHECK(weights.row(4).isApprox(Eigen::RowVector3d(1, 22, 25) / 48));
}

TEST_CASE("subdivision: faces are oriented quads over all vertices of faces") {
  const Quads quads = subdivided_faces(mixed_cage(), 2);
  CHECK(quads.rows() == 4 * 7);
  // Each inner edge is used once in either direction.
  std::vector<std::pair<Index, Index>> directed;
  for (Index face = 0; face < quads.rows(); ++face)
    for (Index k = 0; k < 4; ++k) directed.emplace_back(quads(face, k), quads(face, (k + 1) % 4));
  std::sort(directed.begin(), directed.end());
  CHECK(std::adjacent_find(directed.begin(), directed.end()) == directed.end());
}

TEST_CASE("subdivision: Loop's scheme gives triangles, with weights that sum to 1") {
  Cage cage = mixed_cage();
  cage.face_corners = {0, 1, 3, 1, 2, 3, 1, 4, 2};
  cage.face_starts = {0, 3, 6, 9};
  cage.edges.conservativeResize(9, 2);
  cage.edges.row(8) << 1, 3;
  cage.edge_crease.push_back(0.3F);
  for (const int levels : {1, 2, 3}) {
    SubdivisionOptions options;
    options.levels = levels;
    options.scheme = SubdivisionScheme::loop;
    const WeightMatrix weights = subdivision_weights(cage, options);
    const Index cuts = 1 << levels;
    CHECK(weights.rows() == 7 + 9 * (cuts - 1) + 3 * (cuts - 1) * (cuts - 2) / 2);
    CHECK((weights * Eigen::VectorXd::Ones(7) - Eigen::VectorXd::Ones(weights.rows())).cwiseAbs().maxCoeff() < 1e-12);
    const Triangles triangles = subdivided_triangles(cage, levels);
    CHECK(triangles.rows() == 3 * cuts * cuts);
    std::vector<std::pair<Index, Index>> directed;
    for (Index face = 0; face < triangles.rows(); ++face)
      for (Index k = 0; k < 3; ++k) directed.emplace_back(triangles(face, k), triangles(face, (k + 1) % 3));
    std::sort(directed.begin(), directed.end());
    CHECK(std::adjacent_find(directed.begin(), directed.end()) == directed.end());
  }
  CHECK_THROWS_WITH_AS(subdivided_triangles(mixed_cage(), 1), doctest::Contains("face 0: it has 4 corners"),
                       InputError);
}

TEST_CASE("subdivision: invalid cages are named") {
  const SubdivisionOptions options;
  Cage cage = mixed_cage();
  cage.face_corners[5] = 7;
  CHECK_THROWS_WITH_AS(subdivision_weights(cage, options), doctest::Contains("face 1: vertex 7"), InputError);
  cage = mixed_cage();
  cage.edges(4, 1) = 6;
  CHECK_THROWS_WITH_AS(subdivision_weights(cage, options),
                       doctest::Contains("face 1: its edge between vertices 1 and 4"), InputError);
  cage = mixed_cage();
  cage.face_starts = {0, 5, 7};
  CHECK_THROWS_WITH_AS(subdivision_weights(cage, options), doctest::Contains("face 1: a face needs"), InputError);
  cage = mixed_cage();
  cage.edge_crease[3] = NAN;
  CHECK_THROWS_WITH_AS(subdivision_weights(cage, options), doctest::Contains("edge 3: crease"), InputError);
  CHECK_THROWS_WITH_AS(subdivision_weights(mixed_cage(), {12, true, 3, false, BoundarySmoothing::all}),
                       doctest::Contains("levels is 12"), InputError);
}

TEST_CASE("subdivision: nothing to subdivide") {
  CHECK(subdivision_weights(Cage{}, {}).rows() == 0);
  Cage points;
  points.vertex_count = 3;
  CHECK(subdivision_weights(points, {}).isApprox(Eigen::MatrixXd::Identity(3, 3).sparseView()));
}
