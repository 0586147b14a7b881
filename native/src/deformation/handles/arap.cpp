// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/deformation/arap.hpp"

#include <limits>
#include <mutex>

#include "deformation/checks.hpp"
#include "deformation/handles/anderson.hpp"
#include "deformation/handles/handle_map.hpp"
#include "deformation/handles/mesh_laplacian.hpp"
#include "deformation/handles/rigid_cells.hpp"

namespace stiv {

namespace {

constexpr int most_steps = 300;
constexpr double least_motion = 1e-11;     // of the mesh's size: a step that moves less is the last
constexpr double least_residual = 1e-10;   // of the first one, in solving for J
constexpr double slack = 1e-12;            // by which rounding may raise an energy
constexpr std::size_t worth_a_factor = 4;  // so many solves by conjugate gradients cost as much as a factor of H

/// The minimum for some controls, and the rotations there.
struct Minimum {
  Controls p;
  Positions u;
  std::vector<RotationFit> fits;
};

class Arap final : public HandleDeformation {
 public:
  Arap(const HandleDefinition& definition, const Surface& mesh)
      : rest_(definition.rest),
        rest_controls_(rest_(definition.handles, Eigen::all)),
        handles_(definition.handles),
        pull_(definition.pull),
        weights_(edge_weights(mesh, rest_, definition.edge_weights)),
        cells_(weights_, rest_),
        map_(definition, mesh, mesh_laplacian(weights_)) {
    if (rest_.rows() > 0) size_ = (rest_.colwise().maxCoeff() - rest_.colwise().minCoeff()).maxCoeff();
  }

  Index control_count() const override { return map_.control_count(); }
  Index vertex_count() const override { return map_.vertex_count(); }

  Positions surface(const Controls& p, const Execution&) const override {
    check_control_rows(p, control_count());
    Positions q = rest_ + minimum(p)->u;
    if (pull_.size() == 0)
      for (Index k = 0; k < control_count(); ++k) q.row(handles_[at(k)]) = p.row(k);
    return q;
  }

  /// J'g = M'(g + C H^-1 g): the transpose of the below.
  SparseField pull_back(const ControlsView& p, const SparseField& g) const override {
    const auto state = minimum(p);
    Positions covector = Positions::Zero(vertex_count(), 3);
    for (std::size_t k = 0; k < g.index.size(); ++k) covector.row(g.index[k]) = g.value[k];
    return map_.pull_back(all_rows(covector + cells_.load_change(state->fits, solve_hessian(*state, covector))));
  }

  /// Many at once, as the contacts of a round: by a factor of H, which all of them share. A contact's covector is one
  /// column, sixteen of them a pass.
  std::vector<SparseField> pull_back_all(const ControlsView& p, const std::vector<SparseField>& g,
                                         const Execution& execution) const override {
    if (g.size() < worth_a_factor) return Deformation::pull_back_all(p, g, execution);
    const auto state = minimum(p);
    const auto factor = SparseFactor::if_definite(free_hessian(*state));
    if (!factor) return Deformation::pull_back_all(p, g, execution);  // at a saddle
    std::vector<SparseField> pulled(g.size());
    execution.for_chunks(static_cast<Index>(g.size()), ColumnBlock::ColsAtCompileTime,
                         [&](Index begin, Index end, Index) {
                           ColumnBlock right = ColumnBlock::Zero(factor->size(), ColumnBlock::ColsAtCompileTime);
                           for (Index k = begin; k < end; ++k) set_column(right, k - begin, g[at(k)]);
                           const ColumnBlock solved = factor->solve(right);
                           for (Index k = begin; k < end; ++k) {
                             Positions covector = cells_.load_change(state->fits, from_column(solved, k - begin));
                             const SparseField& field = g[at(k)];
                             for (std::size_t i = 0; i < field.index.size(); ++i)
                               covector.row(field.index[i]) += field.value[i];
                             pulled[at(k)] = map_.pull_back(all_rows(covector));
                           }
                         });
    return pulled;
  }

  /// J d = M d + H^-1 C M d: the global step with frozen rotations, and how the rotations answer it.
  Positions push_forward(const Controls& p, const Controls& d) const override {
    check_control_rows(d, control_count());
    const auto state = minimum(p);
    const Positions frozen = map_.follow(d);
    return frozen + solve_hessian(*state, cells_.load_change(state->fits, frozen));
  }

  std::unique_ptr<Metric> metric(const MetricOptions& options) const override { return map_.metric(options, nullptr); }

  std::unique_ptr<Metric> metric(const MetricOptions& options, const WeightMatrix& surface_gram) const override {
    return map_.metric(options, &surface_gram);
  }

  std::vector<Index> support(Index control) const override { return map_.support(control); }

 private:
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

  /// Rounds ask for J where they have just asked for the surface, many times: the last minimum is kept.
  std::shared_ptr<const Minimum> minimum(const ControlsView& p) const {
    {
      const std::lock_guard lock(mutex_);
      if (last_ && last_->p == p) return last_;
    }
    auto found = std::make_shared<const Minimum>(find_minimum(p));
    const std::lock_guard lock(mutex_);
    last_ = found;
    return found;
  }

  Minimum find_minimum(const ControlsView& p) const {
    const Controls d = p - rest_controls_;
    const Positions start = map_.follow(d);
    Minimum state{p, start, cells_.fit(start)};
    if (d.isZero(0)) return state;
    AndersonAcceleration acceleration;
    Positions plain = state.u;
    double before = std::numeric_limits<double>::infinity();
    for (int step = 0; step < most_steps; ++step) {
      double now = energy(state.u, state.fits, d);
      if (now > before * (1 + slack)) {  // led astray: the global step itself never raises it
        acceleration.restart();
        state.u = plain;
        state.fits = cells_.fit(state.u, state.fits);
        now = energy(state.u, state.fits, d);
      }
      before = now;
      plain = start + map_.answer(cells_.load(state.fits));
      const double motion = (plain - state.u).cwiseAbs().maxCoeff();
      state.u = motion <= least_motion * size_ ? plain : acceleration.next(state.u, plain);
      state.fits = cells_.fit(state.u, state.fits);
      if (motion <= least_motion * size_) break;
    }
    return state;
  }

  /// H^-1 r of the free vertices, H = K - C the Hessian of the energy with its rotations: conjugate gradients with the
  /// factor of K. (K z = r is known, so K is never multiplied with.) It ends early where H is not positive: at a
  /// saddle.
  Positions solve_hessian(const Minimum& state, const Positions& right) const {
    Positions y = Positions::Zero(vertex_count(), 3), residual = freed(right);
    Positions z = map_.answer(residual), direction = z, pushed = residual;
    double product = residual.cwiseProduct(z).sum();
    const double end = least_residual * least_residual * product;
    for (int step = 0; step < most_steps && product > end; ++step) {
      const Positions curved = pushed - freed(cells_.load_change(state.fits, direction));
      const double curvature = direction.cwiseProduct(curved).sum();
      if (!(curvature > 0)) break;
      const double length = product / curvature;
      y += length * direction;
      residual -= length * curved;
      z = map_.answer(residual);
      const double next = residual.cwiseProduct(z).sum(), share = next / product;
      direction = z + share * direction;
      pushed = residual + share * pushed;
      product = next;
    }
    return y;
  }

  /// H = K + S'A S - C of the free vertices, three rows each.
  SymmetricMatrix free_hessian(const Minimum& state) const {
    const std::vector<Index>& place = map_.partition().place;
    std::vector<Eigen::Triplet<double, Index>> entries;
    const auto add = [&](Index row, Index column, double value) {
      const Index i = place[at(row / 3)], j = place[at(column / 3)];
      if (i >= 0 && j >= 0) entries.emplace_back(3 * i + row % 3, 3 * j + column % 3, value);
    };
    const SymmetricMatrix stiffness = mesh_laplacian(weights_), change = cells_.load_matrix(state.fits);
    for (Index column = 0; column < stiffness.cols(); ++column)
      for (SymmetricMatrix::InnerIterator entry(stiffness, column); entry; ++entry)
        for (Index axis = 0; axis < 3; ++axis)
          add(3 * static_cast<Index>(entry.row()) + axis, 3 * column + axis, entry.value());
    for (Index k = 0; k < pull_.size(); ++k)
      for (Index axis = 0, row = 3 * handles_[at(k)]; axis < 3; ++axis) add(row + axis, row + axis, pull_[k]);
    for (Index column = 0; column < change.cols(); ++column)
      for (SymmetricMatrix::InnerIterator entry(change, column); entry; ++entry)
        add(static_cast<Index>(entry.row()), column, -entry.value());
    const auto count = 3 * static_cast<Index>(map_.partition().free.size());
    SymmetricMatrix hessian(count, count);
    hessian.setFromTriplets(entries.begin(), entries.end());
    return hessian;
  }

  void set_column(ColumnBlock& block, Index column, const SparseField& field) const {
    for (std::size_t k = 0; k < field.index.size(); ++k)
      if (const Index place = map_.partition().place[at(field.index[k])]; place >= 0)
        block.col(column).segment<3>(3 * place) = field.value[k];
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

  /// The rows of the vertices that are solved for; 0 elsewhere.
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
  HandleMap map_;
  double size_ = 0;
  mutable std::mutex mutex_;
  mutable std::shared_ptr<const Minimum> last_;
};

}  // namespace

std::shared_ptr<const HandleDeformation> make_arap(const HandleDefinition& definition) {
  return std::make_shared<Arap>(definition, checked_mesh(definition));
}

}  // namespace stiv
