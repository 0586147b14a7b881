// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>
#include <memory>
#include <vector>

#include "stiv/acceptance/storage.hpp"
#include "stiv/editing/session.hpp"

namespace stiv {

/// A surface, the deformation that moves it, and the mesh whose vertices are the controls. A contraction smooths the
/// cage until the surface is free of intersections. [P5.2, "Self-intersecting meshes", for surfaces edited by cages]
struct CagedSurface {
  std::shared_ptr<const Surface> surface;          ///< N vertices
  std::shared_ptr<const Deformation> deformation;  ///< from m controls to the N vertices
  std::shared_ptr<const Surface> cage;             ///< m vertices
};

/// A surface that is its own cage: all vertices are controls.
CagedSurface without_cage(const std::shared_ptr<const Surface>& surface);

/// The factors of a contraction that depend on the shape at the start.
struct ContractionSystem {
  Eigen::SparseMatrix<double, Eigen::ColMajor, Index> laplacian;  ///< (N, N) L: (L q)_i = sum_j w_ij (q_j - q_i)
  Eigen::VectorXd areas;                                          ///< (N) barycentric area of each vertex
  std::vector<Index> moving;                                      ///< vertices to contract, ascending
};

/// Cotangent weights and areas of a surface at q, (N, 3). Weights are clamped to [1e-3, 20], so that obtuse and
/// degenerate triangles do not reverse a step. Loose edges have weight 1. The weights are those of the start: weights
/// of the contracted shape, as published, collapse thin limbs into spikes. (mathematics.md, "Contraction")
/// @param moves (N) nonzero for vertices to contract; empty: all
/// @throws InputError if the size of q or `moves` does not match the surface
ContractionSystem contraction_system(const Surface& surface, const Positions& q,
                                     const std::vector<unsigned char>& moves);

/// One step of contraction toward the skeleton by constrained Laplacian smoothing: the least-squares solution x of
///   w L x = 0,   sqrt(A_i / a_i) x_i = sqrt(A_i / a_i) q_i
/// over the moving vertices, with areas A_i at the start and a_i at q. The other vertices stay. [P5.2; Au et al.,
/// Skeleton extraction by mesh contraction, 2008, Eq. 1; factor weights of their section 4.1]
/// @param smoothing w > 0, independent of the size of the shape; Au et al. double it at each step
/// @throws InputError if the system is singular
Positions contraction_step(const Surface& surface, const ContractionSystem& system, const Positions& q,
                           double smoothing);

struct ContractionOptions {
  double smoothing = 1;               ///< w of the first step
  double growth = 2;                  ///< factor of w from one step to the next, above 1
  int max_steps = 16;                 ///< at least 0
  double tolerance = 2;               ///< stops at this many times the fewest pairs so far; at least 1
  double time_budget = 0;             ///< seconds; then the steps so far count. 0: no limit, as within a repair
  std::vector<StorageFrame> storage;  ///< positions are rounded as stored before they are tested
};

struct ContractionResult {
  Controls positions;        ///< (m, 3) of the step with the fewest pairs; the start if no step has fewer
  bool free = false;         ///< true if nothing intersects there
  std::vector<Index> pairs;  ///< number of intersecting pairs at the start and after each step
  bool out_of_time = false;  ///< the time budget ended the contraction
};

/// Contracts the cage step by step until nothing of the surface intersects, or until intersections grow: contraction
/// can create some. [P5.2; mathematics.md, "Contraction"]
/// @param p (m, 3) controls
/// @param moves (m) as contraction_system of the cage
/// @throws InputError for invalid sizes and options; Interrupted
ContractionResult contract(const CagedSurface& caged, const Controls& p, const std::vector<unsigned char>& moves,
                           const ContractionOptions& options, Execution& execution);

/// The same for a surface that is its own cage, at q, (N, 3).
inline ContractionResult contract(const std::shared_ptr<const Surface>& surface, const Positions& q,
                                  const std::vector<unsigned char>& moves, const ContractionOptions& options,
                                  Execution& execution) {
  return contract(without_cage(surface), q, moves, options, execution);
}

/// Undoes a contraction: one edit from controls `from`, free of intersections, toward `target`, (m, 3) each, then
/// settling. The target may be any shape of the same vertices. [P5.2, "Self-intersecting meshes"]
/// @throws InputError for invalid sizes and options; StartIntersectsError
EditResult expand(const std::shared_ptr<const Surface>& surface, const std::shared_ptr<const Deformation>& deformation,
                  const Controls& from, const Controls& target, const EditOptions& options, Execution& execution);

/// The same with every vertex a control.
EditResult expand(const std::shared_ptr<const Surface>& surface, const Positions& from, const Positions& target,
                  const EditOptions& options, Execution& execution);

}  // namespace stiv
