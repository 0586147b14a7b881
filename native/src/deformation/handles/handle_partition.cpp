// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/handles/handle_partition.hpp"

#include <cmath>
#include <string>

#include "deformation/checks.hpp"
#include "stiv/error.hpp"

namespace stiv {

namespace {

void check_vertex(Index vertex, Index count, const std::string& name) {
  if (vertex < 0 || vertex >= count)
    throw InputError(name + ": vertex " + std::to_string(vertex) + " does not exist; there are " +
                     std::to_string(count));
}

/// The control of each vertex, -1 if it is not a handle.
std::vector<Index> controls_of_vertices(const HandleDefinition& definition) {
  const auto count = static_cast<Index>(definition.rest.rows());
  std::vector<Index> control(static_cast<std::size_t>(count), -1);
  for (std::size_t k = 0; k < definition.handles.size(); ++k) {
    const std::string name = "handle " + std::to_string(k);
    const Index vertex = definition.handles[k];
    check_vertex(vertex, count, name);
    Index& taken = control[at(vertex)];
    if (taken >= 0)
      throw InputError(name + ": vertex " + std::to_string(vertex) + " is already handle " + std::to_string(taken));
    taken = static_cast<Index>(k);
  }
  return control;
}

void check_pull(const HandleDefinition& definition) {
  const Eigen::VectorXd& pull = definition.pull;
  if (pull.size() == 0) return;
  if (pull.size() != static_cast<Eigen::Index>(definition.handles.size()))
    throw InputError("handles: there are " + std::to_string(definition.handles.size()) + ", but " +
                     std::to_string(pull.size()) + " pulls; give one for each handle, or none");
  for (Eigen::Index k = 0; k < pull.size(); ++k)
    if (!(pull[k] > 0) || !std::isfinite(pull[k]))
      throw InputError("handle " + std::to_string(k) + ": its pull must be positive and finite");
}

void check_fixed(const HandleDefinition& definition) {
  const std::vector<Index> control = controls_of_vertices(definition);
  for (const Index vertex : definition.fixed) {
    check_vertex(vertex, static_cast<Index>(definition.rest.rows()), "fixed");
    if (const Index handle = control[at(vertex)]; handle >= 0)
      throw InputError("fixed: vertex " + std::to_string(vertex) + " is handle " + std::to_string(handle) +
                       "; choose one of the two");
  }
}

}  // namespace

Surface checked_mesh(const HandleDefinition& definition) {
  check_finite(definition.rest, "rest position of vertex");
  check_pull(definition);
  check_fixed(definition);
  SurfaceDefinition mesh;
  mesh.vertex_count = static_cast<Index>(definition.rest.rows());
  mesh.triangles = definition.triangles;
  return Surface(std::move(mesh));
}

HandlePartition handle_partition(const HandleDefinition& definition, const Surface& mesh) {
  const auto count = static_cast<std::size_t>(mesh.vertex_count());
  HandlePartition partition;
  partition.control = controls_of_vertices(definition);
  partition.component = mesh.connected_components();
  partition.place.assign(count, -1);
  std::vector<unsigned char> moves(count, 0), held(count, 0);
  for (const Index handle : definition.handles) moves[at(partition.component[at(handle)])] = 1;
  for (const Index vertex : definition.fixed) held[at(vertex)] = 1;
  const bool hard = definition.pull.size() == 0;
  for (std::size_t vertex = 0; vertex < count; ++vertex) {
    const bool still =
        !moves[at(partition.component[vertex])] || held[vertex] || (hard && partition.control[vertex] >= 0);
    if (still) continue;
    partition.place[vertex] = static_cast<Index>(partition.free.size());
    partition.free.push_back(static_cast<Index>(vertex));
  }
  return partition;
}

}  // namespace stiv
