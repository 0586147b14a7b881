// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/handles/rigid_cells.hpp"

#include <utility>

#include "deformation/rotation.hpp"

namespace stiv {

namespace {

/// In radians. Each fit starts from the previous one, and the turns shrink as the positions converge.
constexpr double settled_turn = 1e-3;

constexpr Index cells_per_chunk = 256;

using Edge = SymmetricMatrix::InnerIterator;

/// The edge from its neighbor to a vertex.
Vector3 across(const Positions& q, Index vertex, const Edge& edge) {
  return (q.row(vertex) - q.row(edge.row())).transpose();
}

}  // namespace

RigidCells::RigidCells(const SymmetricMatrix& weights, Positions rest) : weights_(weights), rest_(std::move(rest)) {}

Eigen::Matrix3d RigidCells::spread(const Positions& u, Index vertex) const {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (Edge edge(weights_, vertex); edge; ++edge) {
    const Vector3 at_rest = across(rest_, vertex, edge);
    sum += edge.value() * (at_rest + across(u, vertex, edge)) * at_rest.transpose();
  }
  return sum;
}

std::vector<RotationFit> RigidCells::fit(const Positions& u, const Execution& execution) const {
  std::vector<RotationFit> fits(static_cast<std::size_t>(weights_.cols()));
  execution.for_chunks(static_cast<Index>(weights_.cols()), cells_per_chunk, [&](Index begin, Index end, Index) {
    for (Index vertex = begin; vertex < end; ++vertex) fits[at(vertex)] = fit_rotation(spread(u, vertex));
  });
  return fits;
}

std::vector<RotationFit> RigidCells::fit(const Positions& u, const std::vector<RotationFit>& nearby,
                                         const Execution& execution) const {
  std::vector<RotationFit> fits(nearby.size());
  execution.for_chunks(static_cast<Index>(weights_.cols()), cells_per_chunk, [&](Index begin, Index end, Index) {
    for (Index vertex = begin; vertex < end; ++vertex)
      fits[at(vertex)] = fit_rotation(spread(u, vertex), nearby[at(vertex)].rotation, settled_turn);
  });
  return fits;
}

double RigidCells::energy(const Positions& u, const std::vector<RotationFit>& fits) const {
  double sum = 0;
  for (Index vertex = 0; vertex < weights_.cols(); ++vertex) {
    const Eigen::Matrix3d& rotation = fits[at(vertex)].rotation;
    for (Edge edge(weights_, vertex); edge; ++edge) {
      const Vector3 at_rest = across(rest_, vertex, edge);
      sum += edge.value() * (at_rest + across(u, vertex, edge) - rotation * at_rest).squaredNorm();
    }
  }
  return sum / 4;
}

Positions RigidCells::load_of(const std::vector<Eigen::Matrix3d>& change) const {
  Positions load(weights_.cols(), 3);
  for (Index vertex = 0; vertex < weights_.cols(); ++vertex) {
    Vector3 sum = Vector3::Zero(), edges = Vector3::Zero();
    for (Edge edge(weights_, vertex); edge; ++edge) {
      const Vector3 weighted = edge.value() * across(rest_, vertex, edge);
      edges += weighted;
      sum += change[at(edge.row())] * weighted;
    }
    load.row(vertex) = (sum + change[at(vertex)] * edges).transpose() / 2;
  }
  return load;
}

Positions RigidCells::load(const std::vector<RotationFit>& fits) const {
  std::vector<Eigen::Matrix3d> change;
  change.reserve(fits.size());
  for (const RotationFit& fit : fits) change.push_back(fit.rotation - Eigen::Matrix3d::Identity());
  return load_of(change);
}

Positions RigidCells::load_change(const std::vector<RotationFit>& fits, const Positions& du) const {
  std::vector<Eigen::Matrix3d> change;
  change.reserve(fits.size());
  for (Index vertex = 0; vertex < weights_.cols(); ++vertex) {
    const RotationFit& fit = fits[at(vertex)];
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (Edge edge(weights_, vertex); edge; ++edge)
      spread += edge.value() * across(du, vertex, edge) * across(rest_, vertex, edge).transpose();
    const Vector3 turn = fit.response * axial(fit.rotation.transpose() * spread);
    change.push_back(fit.rotation * cross_matrix(turn));
  }
  return load_of(change);
}

void RigidCells::visit_load_blocks(const std::vector<RotationFit>& fits,
                                   const std::function<void(Index, Index, const Eigen::Matrix3d&)>& visit) const {
  std::vector<std::pair<Index, Eigen::Matrix3d>> turns;  // T_i: vertices of the cell and their blocks
  for (Index vertex = 0; vertex < weights_.cols(); ++vertex) {
    const RotationFit& fit = fits[at(vertex)];
    turns.assign(1, {vertex, Eigen::Matrix3d::Zero()});
    for (Edge edge(weights_, vertex); edge; ++edge) {
      const Eigen::Matrix3d turn = edge.value() * cross_matrix(across(rest_, vertex, edge)) * fit.rotation.transpose();
      turns.front().second += turn;
      turns.emplace_back(static_cast<Index>(edge.row()), -turn);
    }
    for (const auto& [column, right] : turns) {
      const Eigen::Matrix3d answer = fit.response * right / 2;
      for (const auto& [row, left] : turns) visit(row, column, left.transpose() * answer);
    }
  }
}

}  // namespace stiv
