// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/repair/contraction.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

#include "repair/caged_surface.hpp"
#include "stiv/acceptance/intersections.hpp"
#include "stiv/deformation/linear.hpp"
#include "stiv/error.hpp"

namespace stiv {

namespace {

using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, Index>;
using Entries = std::vector<Eigen::Triplet<double, Index>>;

constexpr double least_weight = 1e-3, greatest_weight = 20;
constexpr double greatest_ratio = 1e6;  // of the areas at the start and now

/// Cotangent of the angle at a, clamped; 1 if both edges have no length.
double safe_cotangent(const Vector3& a, const Vector3& b, const Vector3& c) {
  const Vector3 u = b - a, v = c - a;
  const double sine = u.cross(v).norm(), cosine = u.dot(v);
  if (sine == 0 && cosine == 0) return 1;
  if (cosine >= greatest_weight * sine) return greatest_weight;
  return std::max(cosine / sine, least_weight);
}

void add_edge(Entries& entries, Index a, Index b, double weight) {
  if (a == b) return;
  entries.emplace_back(a, b, weight);
  entries.emplace_back(b, a, weight);
  entries.emplace_back(a, a, -weight);
  entries.emplace_back(b, b, -weight);
}

Matrix cotangent_laplacian(const Surface& surface, const Positions& q) {
  const Triangles& triangles = surface.triangles();
  Entries entries;
  entries.reserve(12 * static_cast<std::size_t>(triangles.rows()));
  for (Index row = 0; row < triangles.rows(); ++row)
    for (Index corner = 0; corner < 3; ++corner) {
      const Index a = triangles(row, corner), b = triangles(row, (corner + 1) % 3),
                  c = triangles(row, (corner + 2) % 3);
      add_edge(entries, b, c, 0.5 * safe_cotangent(q.row(a), q.row(b), q.row(c)));
    }
  for (Index row = 0; row < surface.loose_edges().rows(); ++row)
    add_edge(entries, surface.loose_edges()(row, 0), surface.loose_edges()(row, 1), 1);
  Matrix laplacian(surface.vertex_count(), surface.vertex_count());
  laplacian.setFromTriplets(entries.begin(), entries.end());
  return laplacian;
}

/// (N, moving) The columns of the moving vertices.
Matrix moving_columns(const ContractionSystem& system) {
  Entries entries;
  for (std::size_t k = 0; k < system.moving.size(); ++k)
    for (Matrix::InnerIterator entry(system.laplacian, system.moving[k]); entry; ++entry)
      entries.emplace_back(entry.row(), static_cast<Index>(k), entry.value());
  Matrix columns(system.laplacian.rows(), static_cast<Index>(system.moving.size()));
  columns.setFromTriplets(entries.begin(), entries.end());
  return columns;
}

/// Squared attraction weights of the moving vertices: they grow as the area shrinks.
Eigen::VectorXd attraction_weights(const ContractionSystem& system, const Eigen::VectorXd& areas) {
  Eigen::VectorXd weights(static_cast<Index>(system.moving.size()));
  for (std::size_t k = 0; k < system.moving.size(); ++k) {
    const double start = system.areas[system.moving[k]], now = areas[system.moving[k]];
    weights[static_cast<Index>(k)] = start >= greatest_ratio * now && start > 0 ? greatest_ratio
                                     : start > 0                                ? start / now
                                                                                : 1;
  }
  return weights;
}

void check(const ContractionOptions& options) {
  if (!(options.smoothing > 0) || !std::isfinite(options.smoothing))
    throw InputError("smoothing must be positive and finite");
  if (!(options.growth > 1) || !std::isfinite(options.growth)) throw InputError("growth must be above 1 and finite");
  if (!(options.tolerance >= 1)) throw InputError("tolerance must be at least 1");
  if (options.max_steps < 0) throw InputError("max_steps must not be negative");
  if (!(options.time_budget >= 0) || !std::isfinite(options.time_budget))
    throw InputError("time_budget must be finite and not negative");
}

/// Adds each step to the result, which is complete after every one.
void contract_step_by_step(const CagedSurface& caged, const Controls& p, const std::vector<unsigned char>& moves,
                           const ContractionOptions& options, Execution& execution, ContractionResult& result) {
  const ContractionSystem system = contraction_system(*caged.cage, p, moves);
  IntersectionTest test(caged.surface);
  const auto pairs_at = [&](const Controls& controls) {
    return test.find_all(caged.deformation->surface_in_range(controls), execution).count();
  };
  Controls now = as_stored(p, options.storage);
  Index fewest = pairs_at(now);
  result.positions = now;
  result.pairs = {fewest};
  double smoothing = options.smoothing;
  for (int step = 0; step < options.max_steps && fewest > 0; ++step) {
    execution.check();
    execution.report("contraction", static_cast<double>(step) / options.max_steps);
    now = as_stored(contraction_step(*caged.cage, system, now, smoothing), options.storage);
    smoothing *= options.growth;
    const Index pairs = pairs_at(now);
    result.pairs.push_back(pairs);
    if (pairs > options.tolerance * fewest) break;
    if (pairs >= fewest) continue;
    fewest = pairs;
    result.positions = now;
  }
  result.free = fewest == 0;
}

}  // namespace

ContractionSystem contraction_system(const Surface& surface, const Positions& q,
                                     const std::vector<unsigned char>& moves) {
  surface.check_positions(q);
  if (!moves.empty() && moves.size() != static_cast<std::size_t>(surface.vertex_count()))
    throw InputError("moves has " + std::to_string(moves.size()) + " entries, the surface has " +
                     std::to_string(surface.vertex_count()) + " vertices");
  ContractionSystem system{cotangent_laplacian(surface, q), surface.vertex_areas(q), {}};
  for (Index vertex = 0; vertex < surface.vertex_count(); ++vertex)
    if (moves.empty() || moves[at(vertex)] != 0) system.moving.push_back(vertex);
  return system;
}

Positions contraction_step(const Surface& surface, const ContractionSystem& system, const Positions& q,
                           double smoothing) {
  if (system.moving.empty()) return q;
  const FloatingPointScope floating_point;
  const Matrix columns = moving_columns(system), transposed = columns.transpose();
  const double factor = smoothing * smoothing;
  Matrix normal = factor * (transposed * columns);
  const Eigen::VectorXd attraction = attraction_weights(system, surface.vertex_areas(q));
  for (Index k = 0; k < normal.cols(); ++k) normal.coeffRef(k, k) += attraction[k];
  // Solves for the displacement, not the position: smooth regions then stay bit for bit.
  const Eigen::Matrix<double, Eigen::Dynamic, 3> curvature =
      system.laplacian * Eigen::Matrix<double, Eigen::Dynamic, 3>(q);
  const Eigen::SimplicialLDLT<Matrix> solver(normal);
  if (solver.info() != Eigen::Success) throw InputError("the contraction is singular: choose a smaller smoothing");
  const Eigen::Matrix<double, Eigen::Dynamic, 3> displacement = solver.solve(-factor * (transposed * curvature));
  Positions contracted = q;
  for (std::size_t k = 0; k < system.moving.size(); ++k)
    contracted.row(system.moving[k]) += displacement.row(static_cast<Index>(k));
  return contracted;
}

ContractionResult contract(const CagedSurface& caged, const Controls& p, const std::vector<unsigned char>& moves,
                           const ContractionOptions& options, Execution& execution) {
  check(options);
  check_caged(caged, p);
  const FloatingPointScope floating_point;
  if (options.time_budget > 0) execution.set_time_budget(options.time_budget);
  ContractionResult result{p, false, {}, false};
  try {
    contract_step_by_step(caged, p, moves, options, execution, result);
  } catch (const Interrupted&) {
    result.out_of_time = options.time_budget > 0 && !execution.cancel_requested();
    if (!result.out_of_time) throw;
  }
  return result;
}

EditResult expand(const std::shared_ptr<const Surface>& surface, const Positions& from, const Positions& target,
                  const EditOptions& options, Execution& execution) {
  return expand(surface, make_identity(surface->vertex_count()), from, target, options, execution);
}

EditResult expand(const std::shared_ptr<const Surface>& surface, const std::shared_ptr<const Deformation>& deformation,
                  const Controls& from, const Controls& target, const EditOptions& options, Execution& execution) {
  EditSession session(surface, deformation, from, options);
  EditResult edited = session.edit(target, execution);
  if (edited.status != EditStatus::corrected && edited.status != EditStatus::blocked) return edited;
  EditResult settled = session.settle(execution);
  settled.path.insert(settled.path.begin(), std::make_move_iterator(edited.path.begin()),
                      std::make_move_iterator(edited.path.end()));
  if (settled.status == EditStatus::unchanged) settled.status = edited.status;
  return settled;
}

}  // namespace stiv
