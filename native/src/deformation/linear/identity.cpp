// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/deformation/linear.hpp"

#include <string>
#include <utility>

#include "deformation/checks.hpp"
#include "stiv/error.hpp"

namespace stiv {

namespace {

class Identity final : public Deformation {
 public:
  explicit Identity(Index vertex_count) : count_(vertex_count) {}

  Index control_count() const override { return count_; }
  Index vertex_count() const override { return count_; }

  Positions surface(const Controls& p, const Execution&) const override {
    check_control_rows(p, count_);
    return p;
  }

  SparseField pull_back(const ControlsView&, const SparseField& g) const override { return g; }

  Positions push_forward(const Controls&, const Controls& d) const override {
    check_control_rows(d, count_);
    return d;
  }

  std::unique_ptr<Metric> metric(const MetricOptions& options) const override {
    return make_control_metric(options, count_, ControlSupport::disjoint);  // J is the identity
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
