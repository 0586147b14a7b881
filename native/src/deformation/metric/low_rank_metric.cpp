// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <random>
#include <utility>

#include "deformation/metric/gram_metric.hpp"

namespace stiv {

namespace {

constexpr double least_eigenvalue = 1e-12;  // of the largest one; smaller ones are rounding errors

/// Probes, (a, rank), and their products with J'J.
struct Probing {
  Eigen::MatrixXd probes, products;
};

/// Random signs, the same on every machine.
Probing probe(const GramProduct& gram, Index rank, const ActiveControls& active, std::mt19937& generator) {
  const auto count = static_cast<Index>(active.control.size());
  Probing probing{Eigen::MatrixXd(count, rank), Eigen::MatrixXd(count, rank)};
  for (Index first = 0; first < rank; first += ColumnBlock::ColsAtCompileTime) {
    ColumnBlock block = ColumnBlock::Zero(static_cast<Index>(active.place.size()), ColumnBlock::ColsAtCompileTime);
    for (const Index control : active.control)
      for (double& value : block.row(control)) value = (generator() & 1U) != 0 ? 1 : -1;
    const ColumnBlock product = gram(block);
    probing.probes.middleCols<ColumnBlock::ColsAtCompileTime>(first) = block(active.control, Eigen::all);
    probing.products.middleCols<ColumnBlock::ColsAtCompileTime>(first) = product(active.control, Eigen::all);
  }
  return probing;
}

struct Spectrum {
  Eigen::MatrixXd vectors;  ///< (a, r) orthonormal
  Eigen::VectorXd values;   ///< (r)
};

/// Columns divided by the square roots of `squares`, without the columns of the smallest ones.
Eigen::MatrixXd normalised(const Eigen::MatrixXd& columns, const Eigen::VectorXd& squares) {
  const double least = least_eigenvalue * std::max(squares.maxCoeff(), 0.0);
  const auto dropped = (squares.array() <= least).count();  // eigenvalues come in ascending order
  const Eigen::Index kept = squares.size() - dropped;
  return columns.rightCols(kept) * squares.tail(kept).cwiseSqrt().cwiseInverse().asDiagonal();
}

/// The eigenvectors of C C' = Y (O'Y)^-1 Y'.
Spectrum spectrum_of(const Probing& probing) {
  const Eigen::MatrixXd inner = probing.probes.transpose() * probing.products;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> first((inner + inner.transpose()) / 2);
  const Eigen::MatrixXd root = normalised(probing.products * first.eigenvectors(), first.eigenvalues());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> second(root.transpose() * root);
  Spectrum spectrum{normalised(root * second.eigenvectors(), second.eigenvalues()), {}};
  spectrum.values = second.eigenvalues().tail(spectrum.vectors.cols());
  return spectrum;
}

/// Estimates the trace of J'J - V L V' by the mean of x'(J'J - V L V')x over random signs x. Without the largest
/// eigenvalues, the variance of the estimate is small. [Meyer et al. 2021, Hutch++]
double remaining_trace(const Spectrum& spectrum, const Probing& fresh) {
  const Eigen::MatrixXd inner = spectrum.vectors.transpose() * fresh.probes;
  const double whole = fresh.probes.cwiseProduct(fresh.products).sum();
  const double known = inner.cwiseProduct(spectrum.values.asDiagonal() * inner).sum();
  return std::max(0.0, whole - known) / static_cast<double>(fresh.probes.cols());
}

class LowRankMetric final : public Metric {
 public:
  /// @param fresh probes independent of the spectrum
  LowRankMetric(Spectrum spectrum, const Probing& fresh, double smoothness, ActiveControls active)
      : active_(std::move(active)), spectrum_(std::move(spectrum)) {
    const auto count = static_cast<double>(active_.control.size());
    const auto rank = static_cast<double>(spectrum_.values.size());
    const double left_over = remaining_trace(spectrum_, fresh);
    const double rest = rank < count ? left_over / (count - rank) : 0;
    const double damping = smoothness * (spectrum_.values.sum() + left_over) / count;
    beyond_ = 1 / (rest + damping);
    within_ = (spectrum_.values.array() + damping).inverse();
  }

  SparseField apply_inverse(const ControlsView&, const SparseField& g) const override {
    const ActiveVector right = restrict_to(active_, g);
    if (right.place.empty()) return {};
    const ActiveColumns whole = dense_columns(active_, right);
    const ActiveColumns inner = spectrum_.vectors.transpose() * whole;
    const ActiveColumns change = (within_.array() - beyond_).matrix().asDiagonal() * inner;
    return extend_from(active_, beyond_ * whole + spectrum_.vectors * change);
  }

 private:
  ActiveControls active_;
  Spectrum spectrum_;
  double beyond_ = 0;       ///< inverse on the orthogonal complement of the eigenvectors
  Eigen::VectorXd within_;  ///< inverse along each eigenvector
};

}  // namespace

std::unique_ptr<Metric> make_low_rank_metric(const GramProduct& gram, Index rank, double smoothness,
                                             ActiveControls active) {
  if (active.control.empty()) return make_gram_metric(Eigen::MatrixXd(0, 0), smoothness, std::move(active));
  std::mt19937 generator(1);
  Spectrum spectrum = spectrum_of(probe(gram, rank, active, generator));
  const Probing fresh = probe(gram, ColumnBlock::ColsAtCompileTime, active, generator);
  return std::make_unique<LowRankMetric>(std::move(spectrum), fresh, smoothness, std::move(active));
}

}  // namespace stiv
