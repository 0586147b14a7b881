// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>
#include <memory>
#include <vector>

#include "stiv/acceptance/storage.hpp"
#include "stiv/execution.hpp"
#include "stiv/repair/caged_surface.hpp"
#include "stiv/surface.hpp"

namespace stiv {

/// What a contraction keeps of the shape that it started from: immutable, and good for all of its steps.
struct ContractionSystem {
  Eigen::SparseMatrix<double, Eigen::ColMajor, Index> laplacian;  ///< (N, N) L: (L q)_i = sum_j w_ij (q_j - q_i)
  Eigen::VectorXd areas;                                          ///< (N) barycentric area of each vertex
  std::vector<Index> moving;                                      ///< vertices that the contraction moves, ascending
};

/// Cotangent weights and areas of a surface at q, (N, 3). Weights are kept between 1e-3 and 20, so that neither obtuse
/// nor degenerate triangles turn a step around; loose edges weigh 1. They stay those of the start: weights of the
/// contracted shape, as first published, collapse thin limbs into spikes. (mathematics.md, "Contraction")
/// @param moves (N) nonzero where a vertex moves; empty: all
/// @throws InputError if q or `moves` do not fit the surface
ContractionSystem contraction_system(const Surface& surface, const Positions& q,
                                     const std::vector<unsigned char>& moves);

/// One step of contraction toward the skeleton by constrained Laplacian smoothing: the least-squares solution x of
///   w L x = 0,   sqrt(A_i / a_i) x_i = sqrt(A_i / a_i) q_i,
/// A_i the areas at the start and a_i those at q, over the moving vertices; the others stay. [P5.2; Au et al., Skeleton
/// extraction by mesh contraction, 2008, Eq. 1; factor weights of their section 4.1]
/// @param smoothing w > 0, the same for any size of the shape; Au et al. double it from step to step
Positions contraction_step(const Surface& surface, const ContractionSystem& system, const Positions& q,
                           double smoothing);

struct ContractionOptions {
  double smoothing = 1;               ///< w of the first step
  double growth = 2;                  ///< factor on w from step to step, above 1
  int max_steps = 16;                 ///< at least 0
  double tolerance = 2;               ///< stops at so many times the fewest pairs so far; at least 1
  std::vector<StorageFrame> storage;  ///< positions are rounded as they will be stored, before they are tested
};

struct ContractionResult {
  Controls positions;        ///< (m, 3) of the step that left the fewest pairs; the start if none left fewer
  bool free = false;         ///< nothing intersects there
  std::vector<Index> pairs;  ///< number of intersecting pairs at the start and after each step
};

/// Steps of the cage until nothing of the surface intersects, or until intersections grow: contraction can create some.
/// [P5.2; mathematics.md, "Contraction"]
/// @param p (m, 3) controls
/// @param moves (m) as for contraction_system of the cage
/// @throws InputError for shapes and options that do not fit; Interrupted
ContractionResult contract(const CagedSurface& caged, const Controls& p, const std::vector<unsigned char>& moves,
                           const ContractionOptions& options, Execution& execution);

/// The same for a surface that is its own cage, at q, (N, 3).
inline ContractionResult contract(const std::shared_ptr<const Surface>& surface, const Positions& q,
                                  const std::vector<unsigned char>& moves, const ContractionOptions& options,
                                  Execution& execution) {
  return contract(without_cage(surface), q, moves, options, execution);
}

}  // namespace stiv
