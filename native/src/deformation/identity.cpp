// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/deformation/identity.hpp"

#include <string>
#include <utility>

#include "deformation/checks.hpp"
#include "stiv/error.hpp"

namespace stiv {

namespace {

/// M^-1 = W: what is sparse stays sparse.
class IdentityMetric final : public Metric {
 public:
  explicit IdentityMetric(Eigen::VectorXd weights) : weights_(std::move(weights)) {}

  SparseField apply_inverse(const Controls&, const SparseField& g) const override {
    SparseField step;
    for (std::size_t k = 0; k < g.index.size(); ++k) {
      const double weight = weights_[g.index[k]];
      if (weight == 0) continue;
      step.index.push_back(g.index[k]);
      step.value.push_back(weight * g.value[k]);
    }
    return step;
  }

  bool is_local() const override { return true; }

 private:
  Eigen::VectorXd weights_;
};

class Identity final : public Deformation {
 public:
  explicit Identity(Index vertex_count) : count_(vertex_count) {}

  Index control_count() const override { return count_; }
  Index vertex_count() const override { return count_; }

  Positions surface(const Controls& p) const override {
    check_control_rows(p, count_);
    return p;
  }

  SparseField pull_back(const Controls&, const SparseField& g) const override { return g; }

  Positions push_forward(const Controls&, const Controls& d) const override {
    check_control_rows(d, count_);
    return d;
  }

  std::unique_ptr<Metric> metric(const MetricOptions& options) const override {
    return std::make_unique<IdentityMetric>(checked_weights(options, count_));
  }

  std::vector<Index> support(Index control) const override { return {control}; }

 private:
  Index count_;
};

}  // namespace

std::shared_ptr<const Deformation> make_identity(Index vertex_count) {
  if (vertex_count < 0) throw InputError("vertex count " + std::to_string(vertex_count) + " is negative");
  return std::make_shared<Identity>(vertex_count);
}

}  // namespace stiv
