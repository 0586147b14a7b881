// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/handle_scenes.hpp"
#include "stiv/acceptance/storage.hpp"
#include "stiv/acceptance/stored_mesh.hpp"
#include "stiv/deformation/arap.hpp"
#include "stiv/deformation/composition.hpp"
#include "stiv/deformation/laplacian.hpp"
#include "stiv/error.hpp"

using namespace stiv;
using namespace stiv::testing;

namespace {

Eigen::Matrix4d turned_frame() {
  Eigen::Matrix4d frame = Eigen::Matrix4d::Identity();
  frame.topLeftCorner<3, 3>() =
      Eigen::AngleAxisd(0.7, Vector3(1, 2, 3).normalized()).toRotationMatrix() * Vector3(2, -0.3, 1).asDiagonal();
  frame.topRightCorner<3, 1>() << 40, -7, 3;
  return frame;
}

/// What a file holds: single precision in the frame.
HandleDefinition read_from_storage(HandleDefinition definition, const Eigen::Matrix4d& frame) {
  definition.rest = as_stored(definition.rest, {{0, static_cast<Index>(definition.rest.rows()), frame}});
  return definition;
}

}  // namespace

TEST_CASE("stored mesh: the surface is what storing its vertices gives back, and rests bit by bit") {
  const Eigen::Matrix4d frame = turned_frame();
  for (const bool hard : {true, false}) {
    const auto definition = read_from_storage(sheet_with_handles(7, hard, EdgeWeights::uniform), frame);
    for (const auto& mesh : {make_laplacian(definition), make_arap(definition)}) {
      const auto stored = make_stored_mesh(mesh, frame);
      CHECK(stored->surface(moved_handles(definition, 0)) == definition.rest);
      const Controls p = moved_handles(definition, 0.4);
      const Positions q = stored->surface(p);
      const Eigen::Affine3d to_world(frame), to_local = to_world.inverse();
      for (Index vertex = 0; vertex < q.rows(); ++vertex) {
        const Eigen::Vector3f local = (to_local * Vector3(mesh->surface(p).row(vertex))).cast<float>();
        CHECK((to_world * local.cast<double>() - Vector3(q.row(vertex))).norm() < 1e-13);
      }
      for (const Index vertex : definition.fixed) CHECK(q.row(vertex) == definition.rest.row(vertex));
    }
  }
}

TEST_CASE("stored mesh: responds as the mesh does, and what follows acts on the stored vertices") {
  const Eigen::Matrix4d frame = turned_frame();
  const auto definition = read_from_storage(sheet_with_handles(5, true, EdgeWeights::uniform), frame);
  const auto mesh = make_laplacian(definition);
  const auto stored = make_stored_mesh(mesh, frame);
  const Controls p = moved_handles(definition, 0.3), d = random_positions(stored->control_count(), 5);
  CHECK(stored->push_forward(p, d) == mesh->push_forward(p, d));
  CHECK(stored->support(1) == mesh->support(1));
  const WeightMatrix weights = Eigen::MatrixXd(random_positions(9, stored->vertex_count()).leftCols(1) *
                                               Eigen::RowVectorXd::Ones(stored->vertex_count()))
                                   .sparseView();
  const auto chain = make_composition(make_linear(weights), stored);
  CHECK((chain->surface(p) - weights * stored->surface(p)).norm() < 1e-12 * chain->surface(p).norm());
}

TEST_CASE("stored mesh: a frame that stores nothing is refused") {
  const auto mesh = make_laplacian(sheet_with_handles(4, true, EdgeWeights::uniform));
  Eigen::Matrix4d frame = Eigen::Matrix4d::Identity();
  frame(1, 1) = 0;
  CHECK_THROWS_WITH_AS(make_stored_mesh(mesh, frame), doctest::Contains("singular"), InputError);
}
