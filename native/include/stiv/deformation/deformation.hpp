// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "stiv/deformation/metric.hpp"
#include "stiv/execution.hpp"
#include "stiv/types.hpp"

namespace stiv {

/// A map q = f(p) from controls to surface positions, and what the response needs of its Jacobian J. [P5.1, App. B]
/// Immutable after construction; every method may be called from several threads.
class Deformation {
 public:
  virtual ~Deformation() = default;

  virtual Index control_count() const = 0;  ///< m
  virtual Index vertex_count() const = 0;   ///< n

  /// q = f(p): (m, 3) -> (n, 3), on the threads of `execution`, which may interrupt it.
  virtual Positions surface(const Controls& p, const Execution& execution) const = 0;
  Positions surface(const Controls& p) const { return surface(p, Execution(1)); }

  /// That as detection and acceptance take it: coordinates below their range (coordinate_range.hpp) are 0.
  Positions surface_in_range(const Controls& p, const Execution& execution = Execution(1)) const;

  /// Rows of the surface, those of some vertices, (k, 3). Here those of the whole surface; others compute only what is
  /// asked for, with the same bits. As-rigid-as-possible deformations give an approximation: rounds look for contacts
  /// in these rows, but the last round and acceptance take the whole surface.
  virtual Positions surface_rows(const Controls& p, std::span<const Index> vertices, const Execution& execution) const;

  /// J(p)' g: a sparse covector over vertices pulled back to controls.
  virtual SparseField pull_back(const ControlsView& p, const SparseField& g) const = 0;

  /// The same for many covectors, as a round asks for them, but for rounding: what is dear for one, such as a factor or
  /// a pass over it, may serve several, and threads share the work. Results do not depend on the number of threads.
  /// @throws Interrupted
  virtual std::vector<SparseField> pull_back_all(const ControlsView& p, const std::vector<SparseField>& g,
                                                 const Execution& execution) const;

  /// J(p) d: the surface's velocity under a motion d of the controls, (m, 3) -> (n, 3). For tests and linearisation.
  virtual Positions push_forward(const Controls& p, const Controls& d) const = 0;

  /// The factored metric of the controls, made once a session. @see Metric
  virtual std::unique_ptr<Metric> metric(const MetricOptions& options) const = 0;

  /// Vertices that control `c` moves, ascending. For local edits.
  virtual std::vector<Index> support(Index control) const = 0;

  /// Rows of the controls that are rotation vectors rather than points, ascending: increments of those are composed as
  /// rotations, and large ones are cut into steps. A concatenation gives those of its parts, shifted.
  virtual std::vector<Index> rotation_rows() const { return {}; }
};

}  // namespace stiv
