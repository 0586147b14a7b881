// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <cmath>
#include <set>

#include "stiv/response/resolver.hpp"

using namespace stiv;

namespace {

/// Weights w_i as the inverse metric: diagonal, 0 pins.
class DiagonalMetric : public Metric {
 public:
  explicit DiagonalMetric(Eigen::VectorXd weights) : weights_(std::move(weights)) {}

  SparseField apply_inverse(const ControlsView&, const SparseField& g) const override {
    SparseField result;
    for (std::size_t k = 0; k < g.index.size(); ++k) {
      if (weights_[g.index[k]] == 0) continue;
      result.index.push_back(g.index[k]);
      result.value.push_back(weights_[g.index[k]] * g.value[k]);
    }
    return result;
  }

 private:
  Eigen::VectorXd weights_;
};

/// q_i = p_i, the simplest deformation there is.
class Copy : public Deformation {
 public:
  explicit Copy(Index count) : count_(count) {}
  Index control_count() const override { return count_; }
  Index vertex_count() const override { return count_; }
  Positions surface(const Controls& p, const Execution&) const override { return p; }
  SparseField pull_back(const ControlsView&, const SparseField& g) const override { return g; }
  Positions push_forward(const Controls&, const Controls& d) const override { return d; }
  std::unique_ptr<Metric> metric(const MetricOptions& options) const override {
    return std::make_unique<DiagonalMetric>(options.weights);
  }
  std::vector<Index> support(Index control) const override { return {control}; }

 private:
  Index count_;
};

Stiv half_space(Index vertex, const Vector3& normal, double volume, double scale = 1) {
  return {scale * volume, {{vertex}, {scale * normal}}};
}

Controls resolve(const std::vector<Stiv>& stivs, const Controls& p, const Eigen::VectorXd& weights, int threads = 1) {
  const Copy deformation(static_cast<Index>(p.rows()));
  const Execution execution(threads);
  ConstraintSet set;
  set.add(control_constraints(stivs, deformation, p, DiagonalMetric(weights), p, &execution));
  return set.project(p, execution);
}

}  // namespace

TEST_CASE("resolver: constraints are normalised in the metric, at any scale") {
  const Copy deformation(2);
  const Controls p = Controls::Random(2, 3);
  const DiagonalMetric metric(Eigen::Vector2d(1, 4));
  for (const double scale : {1e-12, 1.0, 1e12}) {
    const auto constraints =
        control_constraints({half_space(1, Vector3::UnitX(), -2, scale)}, deformation, p, metric, p);
    REQUIRE(constraints.size() == 1);
    CHECK(constraints[0].row.value[0].dot(constraints[0].step.value[0]) == doctest::Approx(1));
    CHECK(constraints[0].bound == doctest::Approx((p(1, 0) + 2) / 2));
  }
}

TEST_CASE("resolver: one half-space is satisfied by the shortest step") {
  const Controls p = Controls::Random(3, 3);
  const Vector3 normal = Vector3(1, 2, -2) / 3;
  Controls expected = p;
  expected.row(1) += 0.7 * normal.transpose();
  CHECK((resolve({half_space(1, normal, -0.7, 5)}, p, Eigen::Vector3d::Ones()) - expected).norm() < 1e-12);
}

TEST_CASE("resolver: weights divide the correction of a pair, and pinned controls do not move") {
  const Controls p = Controls::Zero(2, 3);
  const Stiv pair{-1, {{0, 1}, {Vector3::UnitZ(), -Vector3::UnitZ()}}};
  const Controls shared = resolve({pair}, p, Eigen::Vector2d(1, 3));
  CHECK(shared(0, 2) == doctest::Approx(0.25));
  CHECK(shared(1, 2) == doctest::Approx(-0.75));
  const Controls pinned = resolve({pair}, p, Eigen::Vector2d(0, 1));
  CHECK(pinned.row(0).norm() == 0);
  CHECK(pinned(1, 2) == doctest::Approx(-1));
}

TEST_CASE("resolver: constraints that no free control can change are left out") {
  const Copy deformation(2);
  const Controls p = Controls::Zero(2, 3);
  const DiagonalMetric metric(Eigen::Vector2d(0, 1));
  CHECK(control_constraints({half_space(0, Vector3::UnitX(), -1)}, deformation, p, metric, p).empty());
  const Stiv rounding{-1, {{0, 1}, {Vector3::UnitX(), 1e-17 * Vector3::UnitX()}}};
  CHECK(control_constraints({rounding}, deformation, p, metric, p).empty());
}

TEST_CASE("resolver: collinear constraints count once, accumulated and new ones are solved together") {
  const Copy deformation(1);
  const Controls p = Controls::Zero(1, 3);
  const DiagonalMetric metric(Eigen::VectorXd::Ones(1));
  const Execution execution(1);
  ConstraintSet set;
  const Stiv right = half_space(0, Vector3::UnitX(), -1);
  set.add(control_constraints({right, right}, deformation, p, metric, p));
  const Controls first = set.project(p, execution);
  CHECK((first.row(0) - Eigen::RowVector3d(1, 0, 0)).norm() < 1e-9);
  const Vector3 oblique = Vector3(-1, 1, 0).normalized();
  set.add(control_constraints({half_space(0, oblique, -std::sqrt(2.0))}, deformation, first, metric, p));
  const Controls second = set.project(p, execution);
  CHECK((second.row(0) - Eigen::RowVector3d(1, 2, 0)).norm() < 1e-8);  // the corner of both half-spaces
}

TEST_CASE("resolver: hundreds of random constraints are satisfied by a combination of their steps") {
  std::srand(11);
  const Index count = 400;
  const Controls p = Controls::Random(count, 3);
  std::vector<Stiv> stivs;
  for (int r = 0; r < 200; ++r) {
    std::set<Index> corners;
    while (corners.size() < 4) corners.insert(static_cast<Index>(std::rand() % count));
    Stiv stiv{-0.01 * (1 + r % 5), {{corners.begin(), corners.end()}, {}}};
    for (int k = 0; k < 4; ++k) stiv.gradient.value.push_back(Vector3::Random());
    stivs.push_back(stiv);
  }
  const Controls resolved = resolve(stivs, p, Eigen::VectorXd::Ones(count));
  for (const Stiv& stiv : stivs) {
    double slack = stiv.volume;
    for (std::size_t k = 0; k < 4; ++k)
      slack += stiv.gradient.value[k].dot((resolved - p).row(stiv.gradient.index[k]).transpose());
    CHECK(slack > -1e-8);
  }
  for (const int threads : {2, 5}) CHECK(resolve(stivs, p, Eigen::VectorXd::Ones(count), threads) == resolved);
}

TEST_CASE("resolver: equations hold for all constraints, also for inactive ones") {
  Controls p = Controls::Zero(2, 3);
  const std::vector<Stiv> stivs{half_space(0, Vector3::UnitX(), -1), half_space(0, Vector3::UnitY(), 0.5),
                                half_space(0, Vector3::UnitX(), -1, 3)};  // the third repeats the first
  const Copy deformation(2);
  const DiagonalMetric metric(Eigen::VectorXd::Ones(2));
  ConstraintSet set;
  set.add(control_constraints(stivs, deformation, p, metric, p));
  const Controls met = set.project_as_equations(p, Execution(1));
  CHECK((met.row(0).transpose() - Vector3(1, -0.5, 0)).norm() < 1e-14);
  CHECK(met.row(1).norm() == 0);
  CHECK((resolve(stivs, p, Eigen::VectorXd::Ones(2)).row(0).transpose() - Vector3(1, 0, 0)).norm() < 1e-9);
}

TEST_CASE("resolver: a set without a part of its constraints projects as if it never had them") {
  constexpr Index count = 9, period = 4, first = 1;
  const Copy deformation(count);
  const DiagonalMetric metric(Eigen::VectorXd::Ones(count));
  const Controls p = Controls::Random(count, 3);
  const Execution execution(1);
  std::vector<Stiv> all, others;
  for (Index k = 0; k < count; ++k) {
    all.push_back(half_space(k, Vector3(1, static_cast<double>(k), -1).normalized(), -1 - static_cast<double>(k)));
    all.back().gradient.index.push_back((k + 1) % count);  // neighbours are coupled
    all.back().gradient.value.push_back(0.5 * Vector3::UnitY());
    if (all.back().gradient.index[1] == 0) std::swap(all.back().gradient.index[0], all.back().gradient.index[1]);
    if (k % period != first) others.push_back(all.back());
  }
  const auto constraints = [&](const std::vector<Stiv>& stivs) {
    return control_constraints(stivs, deformation, p, metric, p);
  };
  ConstraintSet set, expected;
  set.add(constraints(all));
  set.project(p, execution);
  set.drop_part(period, first);
  expected.add(constraints(others));
  CHECK(set.size() == expected.size());
  CHECK(set.project(p, execution).isApprox(expected.project(p, execution), 1e-8));
}
