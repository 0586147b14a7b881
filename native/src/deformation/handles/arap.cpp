// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/deformation/handles.hpp"

#include <limits>
#include <mutex>
#include <optional>

#include "deformation/checks.hpp"
#include "deformation/handles/anderson.hpp"
#include "deformation/handles/block_factor.hpp"
#include "deformation/handles/handle_map.hpp"
#include "deformation/handles/mesh_laplacian.hpp"
#include "deformation/handles/rigid_cells.hpp"
#include "position_rows.hpp"

namespace stiv {

namespace {

constexpr int most_steps = 300;
constexpr double least_motion = 1e-11;    // of the mesh's size: a shorter step is the last
constexpr double rough_motion = 1e-6;     // the same while rounds find and linearise contacts
constexpr double least_residual = 1e-10;  // relative to the first one, when solving for J
constexpr double slack = 1e-12;           // relative increase of an energy that rounding may cause

/// Displacements near a minimum, and the rotations there.
struct Shape {
  Positions u;
  std::vector<RotationFit> fits;
};

/// The iteration toward the minimum for some controls.
struct Descent {
  Shape shape;
  Positions start, plain;  ///< the first global step, with all rotations 1; the last one, not accelerated
  AndersonAcceleration acceleration = {};
  double energy = std::numeric_limits<double>::infinity();
  int step = 0;
};

/// The minimum for some controls: exact for the surface, approximate for rounds.
struct Minimum {
  Controls p;
  Shape rough;
  Descent descent;  ///< ends at the minimum if `is_exact`, else at `rough`
  bool is_exact = false;
};

/// An entry for each pair of free vertices in one cell.
SymmetricMatrix pattern_within_two_rings(const SymmetricMatrix& stiffness, const HandlePartition& partition) {
  const SymmetricMatrix within = stiffness.cwiseAbs() * stiffness.cwiseAbs();
  std::vector<Eigen::Triplet<double, Index>> entries;
  for (const Index column : partition.free)
    for (SymmetricMatrix::InnerIterator entry(within, column); entry; ++entry)
      if (const Index row = partition.place[at(static_cast<Index>(entry.row()))]; row >= 0)
        entries.emplace_back(row, partition.place[at(column)], 1);
  const auto count = static_cast<Index>(partition.free.size());
  SymmetricMatrix pattern(count, count);
  pattern.setFromTriplets(entries.begin(), entries.end());
  return pattern;
}

class Arap final : public HandleDeformation {
 public:
  Arap(const HandleDefinition& definition, const Surface& mesh)
      : rest_(definition.rest),
        rest_controls_(rest_(definition.handles, Eigen::all)),
        handles_(definition.handles),
        pull_(definition.pull),
        weights_(edge_weights(mesh, rest_, definition.edge_weights)),
        cells_(weights_, rest_),
        stiffness_(mesh_laplacian(weights_)),
        map_(definition, mesh, stiffness_) {
    if (rest_.rows() > 0) size_ = (rest_.colwise().maxCoeff() - rest_.colwise().minCoeff()).maxCoeff();
  }

  Index control_count() const override { return map_.control_count(); }
  Index vertex_count() const override { return map_.vertex_count(); }

  Positions surface(const Controls& p, const Execution& execution) const override {
    check_control_rows(p, control_count());
    return positions(minimum(p, true, execution)->descent.shape, p);
  }

  bool has_exact_rows() const override { return false; }

  Positions surface_rows(const Controls& p, std::span<const Index> vertices,
                         const Execution& execution) const override {
    check_control_rows(p, control_count());
    return rows_of(positions(minimum(p, false, execution)->rough, p), vertices);
  }

  /// J'g = M'(g + C H^-1 g), the transpose of J below.
  SparseField pull_back(const ControlsView& p, const SparseField& g) const override {
    const auto state = minimum(p, false, Execution(1));
    Positions covector = Positions::Zero(vertex_count(), 3);
    for (std::size_t k = 0; k < g.index.size(); ++k) covector.row(g.index[k]) = g.value[k];
    return pulled_through(state->rough, solve_hessian(state->rough, covector), g);
  }

  /// Many covectors, such as the contacts of a round, share a factor of H. Each contact's covector is one column, and
  /// each pass solves for sixteen columns.
  std::vector<SparseField> pull_back_all(const ControlsView& p, const std::vector<SparseField>& g,
                                         const Execution& execution) const override {
    const auto state = minimum(p, false, execution);
    const auto factor = factor_hessian(state->rough);
    if (!factor) return Deformation::pull_back_all(p, g, execution);  // at a saddle
    std::vector<SparseField> pulled(g.size());
    execution.for_chunks(
        static_cast<Index>(g.size()), ColumnBlock::ColsAtCompileTime, [&](Index begin, Index end, Index) {
          ColumnBlock right = ColumnBlock::Zero(3 * hessian_pattern().size(), ColumnBlock::ColsAtCompileTime);
          for (Index k = begin; k < end; ++k) set_column(right, k - begin, g[at(k)]);
          const ColumnBlock solved = factor->solve(right);
          for (Index k = begin; k < end; ++k)
            pulled[at(k)] = pulled_through(state->rough, from_column(solved, k - begin), g[at(k)]);
        });
    return pulled;
  }

  /// J d = M d + H^-1 C M d: the global step with frozen rotations, and the response of the rotations.
  Positions push_forward(const Controls& p, const Controls& d) const override {
    check_control_rows(d, control_count());
    const auto state = minimum(p, false, Execution(1));
    const Positions frozen = map_.follow(d);
    return frozen + solve_hessian(state->rough, cells_.load_change(state->rough.fits, frozen));
  }

  /// A column of J takes a solve as a row does, and sixteen share a pass over the factor of H.
  bool has_cheaper_columns() const override { return 3 * control_count() < vertex_count(); }

  void visit_columns(const Controls& p, const Execution& execution,
                     const std::function<void(Index, const ControlColumns&)>& visit) const override {
    check_control_rows(p, control_count());
    const auto state = minimum(p, false, execution);
    const auto factor = factor_hessian(state->rough);
    if (!factor) return Deformation::visit_columns(p, execution, visit);  // at a saddle
    constexpr Index controls_per_chunk = ColumnBlock::ColsAtCompileTime / 3;
    execution.for_chunks(control_count(), controls_per_chunk, [&](Index begin, Index end, Index) {
      std::vector<ControlColumns> columns;
      for (Index control = begin; control < end; ++control) columns.push_back(frozen_columns(control));
      add_turns(columns, state->rough, *factor);
      for (Index control = begin; control < end; ++control) visit(control, columns[at(control - begin)]);
    });
  }

  std::unique_ptr<Metric> metric(const MetricOptions& options) const override { return map_.metric(options, nullptr); }

  std::unique_ptr<Metric> metric(const MetricOptions& options, const WeightMatrix& surface_gram) const override {
    return map_.metric(options, &surface_gram);
  }

  std::vector<Index> support(Index control) const override { return map_.support(control); }

 private:
  /// J'g with y = H^-1 g: A S y for soft handles, since J = H^-1 S'A; M'(g + C y) for hard ones.
  SparseField pulled_through(const Shape& shape, const Positions& y, const SparseField& g) const {
    if (pull_.size() == 0) {
      Positions covector = cells_.load_change(shape.fits, y);
      for (std::size_t k = 0; k < g.index.size(); ++k) covector.row(g.index[k]) += g.value[k];
      return map_.pull_back(all_rows(covector));
    }
    SparseField pulled;
    for (Index k = 0; k < control_count(); ++k) {
      pulled.index.push_back(k);
      pulled.value.push_back(pull_[k] * y.row(handles_[at(k)]));
    }
    return pulled;
  }

  /// M d for the unit motions d of a control. M is the same for x, y and z.
  ControlColumns frozen_columns(Index control) const {
    Controls unit = Controls::Zero(control_count(), 3);
    unit.row(control).setOnes();
    const Positions followed = map_.follow(unit);
    ControlColumns columns;
    for (const int axis : {0, 1, 2}) {
      columns[at(axis)] = Positions::Zero(vertex_count(), 3);
      columns[at(axis)].col(axis) = followed.col(axis);
    }
    return columns;
  }

  /// Adds H^-1 C M d, the response of the rotations, to M d for up to five controls.
  void add_turns(std::vector<ControlColumns>& columns, const Shape& shape, const BlockFactor& factor) const {
    ColumnBlock right = ColumnBlock::Zero(3 * hessian_pattern().size(), ColumnBlock::ColsAtCompileTime);
    for (Index k = 0; k < 3 * static_cast<Index>(columns.size()); ++k)
      set_column(right, k, cells_.load_change(shape.fits, columns[at(k / 3)][at(k % 3)]));
    const ColumnBlock solved = factor.solve(right);
    for (Index k = 0; k < 3 * static_cast<Index>(columns.size()); ++k)
      columns[at(k / 3)][at(k % 3)] += from_column(solved, k);
  }

  static SparseField all_rows(const Positions& values) {
    SparseField field;
    for (Index row = 0; row < values.rows(); ++row) {
      field.index.push_back(row);
      field.value.push_back(values.row(row));
    }
    return field;
  }

  double energy(const Positions& u, const std::vector<RotationFit>& fits, const Controls& d) const {
    double sum = cells_.energy(u, fits);
    for (Index k = 0; k < pull_.size(); ++k) sum += pull_[k] / 2 * (u.row(handles_[at(k)]) - d.row(k)).squaredNorm();
    return sum;
  }

  /// The last minimum is cached: rounds evaluate some rows of the surface, then J and the whole surface at the same
  /// controls.
  std::shared_ptr<const Minimum> minimum(const ControlsView& p, bool exact, const Execution& execution) const {
    std::shared_ptr<const Minimum> last = last_minimum();
    const bool is_known = last && last->p == p;
    if (is_known && (last->is_exact || !exact)) return last;
    const Controls d = p - rest_controls_;
    Minimum found = is_known ? *last : Minimum{p, {}, begin(d, execution)};
    if (!is_known) {
      descend(found.descent, d, rough_motion, execution);
      found.rough = found.descent.shape;
    }
    if (exact) {
      descend(found.descent, d, least_motion, execution);
      found.descent.acceleration.restart();  // frees its memory
    }
    found.is_exact = exact;
    auto shared = std::make_shared<const Minimum>(std::move(found));
    const std::lock_guard lock(mutex_);
    last_ = shared;
    return shared;
  }

  std::shared_ptr<const Minimum> last_minimum() const {
    const std::lock_guard lock(mutex_);
    return last_;
  }

  Positions positions(const Shape& shape, const Controls& p) const {
    Positions q = rest_ + shape.u;
    if (pull_.size() == 0)
      for (Index k = 0; k < control_count(); ++k) q.row(handles_[at(k)]) = p.row(k);
    return q;
  }

  Descent begin(const Controls& d, const Execution& execution) const {
    const Positions start = map_.follow(d);
    return {{start, cells_.fit(start, execution)}, start, start};
  }

  /// Repeats local and global steps until one moves less than `least` times the mesh's size. A descent that is
  /// continued later has the same bits as an uninterrupted one.
  void descend(Descent& descent, const Controls& d, double least, const Execution& execution) const {
    if (d.isZero(0)) return;
    auto& [shape, start, plain, acceleration, before, step] = descent;
    for (; step < most_steps; ++step) {
      double now = energy(shape.u, shape.fits, d);
      if (now > before * (1 + slack)) {  // the extrapolation failed: a global step never raises the energy
        acceleration.restart();
        shape.u = plain;
        shape.fits = cells_.fit(shape.u, shape.fits, execution);
        now = energy(shape.u, shape.fits, d);
      }
      before = now;
      plain = start + map_.solve(cells_.load(shape.fits));
      const double motion = (plain - shape.u).cwiseAbs().maxCoeff();
      if (motion <= least * size_) return;
      shape.u = acceleration.next(shape.u, plain);
      shape.fits = cells_.fit(shape.u, shape.fits, execution);
    }
  }

  /// H^-1 r for the free vertices by conjugate gradients, preconditioned with the factor of K. H = K - C is the Hessian
  /// of the energy, rotations included. (K z = r is known, so no product with K is computed.) Ends early at a saddle,
  /// where H is not positive definite.
  Positions solve_hessian(const Shape& shape, const Positions& right) const {
    Positions y = Positions::Zero(vertex_count(), 3), residual = freed(right);
    Positions z = map_.solve(residual), direction = z, pushed = residual;
    double product = residual.cwiseProduct(z).sum();
    const double end = least_residual * least_residual * product;
    for (int step = 0; step < most_steps && product > end; ++step) {
      const Positions curved = pushed - freed(cells_.load_change(shape.fits, direction));
      const double curvature = direction.cwiseProduct(curved).sum();
      if (!(curvature > 0)) break;
      const double length = product / curvature;
      y += length * direction;
      residual -= length * curved;
      z = map_.solve(residual);
      const double next = residual.cwiseProduct(z).sum(), share = next / product;
      direction = z + share * direction;
      pushed = residual + share * pushed;
      product = next;
    }
    return y;
  }

  const BlockPattern& hessian_pattern() const {
    std::call_once(pattern_made_, [&] { pattern_.emplace(pattern_within_two_rings(stiffness_, map_.partition())); });
    return *pattern_;
  }

  /// The factor of H = K + S'A S - C for the free vertices; nothing at a saddle.
  std::unique_ptr<const BlockFactor> factor_hessian(const Shape& shape) const {
    const std::vector<Index>& place = map_.partition().place;
    const BlockPattern& pattern = hessian_pattern();
    std::vector<Eigen::Matrix3d> blocks(pattern.entries() + 1, Eigen::Matrix3d::Zero());  // last: ignored
    const auto block_at = [&](Index row, Index column) -> Eigen::Matrix3d& {
      const Index i = place[at(row)], j = place[at(column)];
      return blocks[i >= 0 && j >= 0 ? pattern.slot(i, j) : pattern.entries()];
    };
    for (Index column = 0; column < stiffness_.cols(); ++column)
      for (SymmetricMatrix::InnerIterator entry(stiffness_, column); entry; ++entry)
        block_at(static_cast<Index>(entry.row()), column).diagonal().array() += entry.value();
    for (Index k = 0; k < pull_.size(); ++k) block_at(handles_[at(k)], handles_[at(k)]).diagonal().array() += pull_[k];
    cells_.visit_load_blocks(
        shape.fits, [&](Index row, Index column, const Eigen::Matrix3d& block) { block_at(row, column) -= block; });
    return BlockFactor::if_definite(pattern, blocks);
  }

  void set_column(ColumnBlock& block, Index column, const SparseField& field) const {
    for (std::size_t k = 0; k < field.index.size(); ++k)
      if (const Index place = map_.partition().place[at(field.index[k])]; place >= 0)
        block.col(column).segment<3>(3 * place) = field.value[k];
  }

  void set_column(ColumnBlock& block, Index column, const Positions& values) const {
    Index row = 0;
    for (const Index vertex : map_.partition().free) {
      block.col(column).segment<3>(row) = values.row(vertex).transpose();
      row += 3;
    }
  }

  Positions from_column(const ColumnBlock& block, Index column) const {
    Positions values = Positions::Zero(vertex_count(), 3);
    Index row = 0;
    for (const Index vertex : map_.partition().free) {
      values.row(vertex) = block.col(column).segment<3>(row).transpose();
      row += 3;
    }
    return values;
  }

  /// The rows of the free vertices; 0 elsewhere.
  Positions freed(const Positions& values) const {
    Positions result = Positions::Zero(values.rows(), 3);
    for (const Index vertex : map_.partition().free) result.row(vertex) = values.row(vertex);
    return result;
  }

  Positions rest_;
  Controls rest_controls_;
  std::vector<Index> handles_;
  Eigen::VectorXd pull_;
  SymmetricMatrix weights_;
  RigidCells cells_;
  SymmetricMatrix stiffness_;  ///< K
  HandleMap map_;
  mutable std::once_flag pattern_made_;
  mutable std::optional<BlockPattern> pattern_;
  double size_ = 0;
  mutable std::mutex mutex_;
  mutable std::shared_ptr<const Minimum> last_;
};

}  // namespace

std::shared_ptr<const HandleDeformation> make_arap(const HandleDefinition& definition) {
  return std::make_shared<Arap>(definition, checked_mesh(definition));
}

}  // namespace stiv
