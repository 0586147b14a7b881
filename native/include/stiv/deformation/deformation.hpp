// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "stiv/deformation/metric.hpp"
#include "stiv/execution.hpp"
#include "stiv/types.hpp"

namespace stiv {

/// Limits of scalar controls, (k) each.
struct ScalarLimits {
  Eigen::VectorXd lower, upper;  ///< infinite: none
  Eigen::VectorXd longest_step;  ///< > 0: the largest change in a linear step of the surface; infinite: any
};

/// Rows of the controls that are scalars, such as angles or slider values, ascending. A row is (value, 0, 0).
struct ScalarRows {
  std::vector<Index> rows;
  ScalarLimits limits;
};

/// Effects of each control on the surface, (m) each.
struct Influence {
  Eigen::VectorXd largest;  ///< the largest motion of a vertex along x for a unit motion of the control
  Eigen::VectorXd miss;     ///< the largest distance of a vertex that the control moves
};

/// A map q = f(p) from controls to surface positions, and the products with its Jacobian J. [P5.1, App. B]
/// Every method may be called from several threads. Immutable, except that J of a function of the caller can be
/// replaced (observed.hpp).
class Deformation {
 public:
  virtual ~Deformation() = default;

  virtual Index control_count() const = 0;  ///< m
  virtual Index vertex_count() const = 0;   ///< n

  /// q = f(p), (n, 3), at controls p, (m, 3), on the threads of `execution`.
  /// @throws Interrupted; InfeasibleError if there is no surface at these controls
  virtual Positions surface(const Controls& p, const Execution& execution) const = 0;
  Positions surface(const Controls& p) const { return surface(p, Execution(1)); }

  /// f(p) as detection and acceptance read it: coordinates below the valid range (coordinate_range.hpp) are 0.
  Positions surface_in_range(const Controls& p, const Execution& execution = Execution(1)) const;

  /// Writes f(p), bit for bit as surface(), into the given rows of q, one for each vertex; empty: the first n.
  virtual void put_surface(const Controls& p, std::span<const Index> rows, Positions& q,
                           const Execution& execution) const;

  /// f(p) at the given vertices, (k, 3), bit for bit as surface(). The base class evaluates the whole surface.
  /// As-rigid-as-possible deformations return an approximation: rounds search these rows for contacts, but the last
  /// round and acceptance evaluate the whole surface.
  virtual Positions surface_rows(const Controls& p, std::span<const Index> vertices, const Execution& execution) const;

  /// Whether surface_rows() has the bits of surface().
  virtual bool has_exact_rows() const { return true; }

  /// J(p)' g: pulls a sparse covector over vertices back to controls.
  virtual SparseField pull_back(const ControlsView& p, const SparseField& g) const = 0;

  /// J(p)' g for many covectors, equal to pull_back() up to rounding. Implementations share factors among the covectors
  /// and covectors among threads. Results do not depend on the number of threads.
  /// @throws Interrupted
  virtual std::vector<SparseField> pull_back_all(const ControlsView& p, const std::vector<SparseField>& g,
                                                 const Execution& execution) const;

  /// J(p) d, (n, 3): the velocity of the surface for a motion d, (m, 3), of the controls.
  virtual Positions push_forward(const Controls& p, const Controls& d) const = 0;

  /// The velocities, (n, 3), of the surface for unit motions of a control along x, y and z.
  using ControlColumns = std::array<Positions, 3>;

  /// Calls visit(control, columns) with the columns of J(p) of each control, once for each, from several threads.
  /// @throws Interrupted
  virtual void visit_columns(const Controls& p, const Execution& execution,
                             const std::function<void(Index, const ControlColumns&)>& visit) const;

  /// Whether all columns of J cost less than all of its rows: where each product is a solve, and controls are few.
  virtual bool has_cheaper_columns() const { return false; }

  /// The influence of the controls at p on vertices with the given distances, (n). Results do not depend on the number
  /// of threads.
  /// @throws Interrupted
  virtual Influence influence(const Controls& p, const Eigen::VectorXd& distances, const Execution& execution) const;

  /// The factored metric of the controls, computed once per session. @see Metric
  virtual std::unique_ptr<Metric> metric(const MetricOptions& options) const = 0;

  /// Grows whenever the caller replaces J (ObservedDeformation::set_jacobian): sessions then factor the metric again.
  virtual std::uint64_t revision() const { return 0; }

  /// Vertices that a control moves, ascending.
  virtual std::vector<Index> support(Index control) const = 0;

  /// Rows of the controls that are rotation vectors, ascending. Their increments are composed as rotations, and large
  /// ones are split into steps.
  virtual std::vector<Index> rotation_rows() const { return {}; }

  /// Rows of the controls that are scalars. Accepted states respect their limits exactly. (scalars.hpp)
  virtual ScalarRows scalar_rows() const { return {}; }
};

}  // namespace stiv
