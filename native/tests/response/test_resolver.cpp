// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <cmath>
#include <set>

#include "stiv/error.hpp"
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

/// An inverse metric that couples all controls, the same for x, y and z.
class CoupledMetric : public Metric {
 public:
  explicit CoupledMetric(Eigen::MatrixXd inverse) : inverse_(std::move(inverse)) {}

  SparseField apply_inverse(const ControlsView&, const SparseField& g) const override {
    Controls step = Controls::Zero(inverse_.rows(), 3);
    for (std::size_t k = 0; k < g.index.size(); ++k) step += inverse_.col(g.index[k]) * g.value[k].transpose();
    SparseField result;
    for (Index control = 0; control < static_cast<Index>(step.rows()); ++control) {
      result.index.push_back(control);
      result.value.push_back(step.row(control).transpose());
    }
    return result;
  }

 private:
  Eigen::MatrixXd inverse_;
};

/// J'J of a band of controls, damped.
Eigen::MatrixXd coupled_gram(Index count) {
  Eigen::MatrixXd gram = 0.1 * Eigen::MatrixXd::Identity(count, count);
  for (Index k = 0; k + 1 < count; ++k) {
    gram(k, k) += 1;
    gram(k + 1, k + 1) += 1;
    gram(k, k + 1) = gram(k + 1, k) = -0.9;
  }
  return gram;
}

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

/// STIVs on four random corners each.
std::vector<Stiv> random_stivs(int number, Index vertex_count) {
  std::vector<Stiv> stivs;
  for (int r = 0; r < number; ++r) {
    std::set<Index> corners;
    while (corners.size() < 4) corners.insert(static_cast<Index>(std::rand() % vertex_count));
    Stiv stiv{-0.01 * (1 + r % 5), {{corners.begin(), corners.end()}, {}}};
    for (int k = 0; k < 4; ++k) stiv.gradient.value.push_back(Vector3::Random());
    stivs.push_back(stiv);
  }
  return stivs;
}

/// V + grad V . (q - p) of each STIV.
Eigen::VectorXd volumes_at(const std::vector<Stiv>& stivs, const Controls& p, const Controls& q) {
  Eigen::VectorXd volumes(static_cast<Eigen::Index>(stivs.size()));
  for (Eigen::Index r = 0; r < volumes.size(); ++r) {
    const Stiv& stiv = stivs[static_cast<std::size_t>(r)];
    volumes[r] = stiv.volume;
    for (std::size_t k = 0; k < 4; ++k)
      volumes[r] += stiv.gradient.value[k].dot((q - p).row(stiv.gradient.index[k]).transpose());
  }
  return volumes;
}

/// All gradients as columns over the coordinates, (3 m, r).
Eigen::MatrixXd gradient_columns(const std::vector<Stiv>& stivs, Index control_count) {
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(3 * control_count, static_cast<Eigen::Index>(stivs.size()));
  for (std::size_t r = 0; r < stivs.size(); ++r)
    for (std::size_t k = 0; k < 4; ++k)
      columns.block<3, 1>(3 * stivs[r].gradient.index[k], static_cast<Eigen::Index>(r)) = stivs[r].gradient.value[k];
  return columns;
}

Controls resolve(const std::vector<Stiv>& stivs, const Controls& p, const Eigen::VectorXd& weights, int threads = 1) {
  const Copy deformation(static_cast<Index>(p.rows()));
  const Execution execution(threads);
  ConstraintSet set;
  const DiagonalMetric metric(weights);
  set.add(control_constraints(stivs, deformation, p, metric, p, &execution), execution);
  return set.project(p, metric, p, execution);
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
  set.add(control_constraints({right, right}, deformation, p, metric, p), execution);
  const Controls first = set.project(p, metric, p, execution);
  CHECK((first.row(0) - Eigen::RowVector3d(1, 0, 0)).norm() < 1e-9);
  const Vector3 oblique = Vector3(-1, 1, 0).normalized();
  set.add(control_constraints({half_space(0, oblique, -std::sqrt(2.0))}, deformation, first, metric, p), execution);
  const Controls second = set.project(p, metric, p, execution);
  CHECK((second.row(0) - Eigen::RowVector3d(1, 2, 0)).norm() < 1e-8);  // the corner of both half-spaces
}

TEST_CASE("resolver: hundreds of random constraints are satisfied by a combination of their steps") {
  std::srand(11);
  const Index count = 400;
  const Controls p = Controls::Random(count, 3);
  const std::vector<Stiv> stivs = random_stivs(200, count);
  const Controls resolved = resolve(stivs, p, Eigen::VectorXd::Ones(count));
  CHECK(volumes_at(stivs, p, resolved).minCoeff() > -1e-8);
  for (const int threads : {2, 5}) CHECK(resolve(stivs, p, Eigen::VectorXd::Ones(count), threads) == resolved);
}

TEST_CASE("resolver: long steps that are not kept lead to the optimum, in batches and after constraints are dropped") {
  std::srand(12);
  const Index count = 300;
  const Copy deformation(count);
  const Controls p = Controls::Random(count, 3);
  const Eigen::MatrixXd gram = coupled_gram(count);
  const CoupledMetric metric(gram.inverse());
  std::vector<Stiv> stivs = random_stivs(70, count);
  for (const int threads : {1, 3}) {
    const Execution execution(threads);
    ConstraintSet set;
    CHECK(add_constraints(set, stivs, deformation, p, metric, p, execution) == 70);
    set.project(p, metric, p, execution);
    set.drop_inactive();
    CHECK(add_constraints(set, stivs, deformation, p, metric, p, execution) == 70);
    const Controls found = set.project(p, metric, p, execution);
    const Eigen::VectorXd volumes = volumes_at(stivs, p, found);
    CHECK(volumes.minCoeff() > -1e-8);
    // M (found - p) is a combination of the gradients of volumes that are zero, with multipliers that are not negative.
    const Controls force = gram * (found - p);
    std::vector<Stiv> active;
    for (std::size_t r = 0; r < stivs.size(); ++r)
      if (volumes[static_cast<Eigen::Index>(r)] < 1e-7) active.push_back(stivs[r]);
    const Eigen::MatrixXd columns = gradient_columns(active, count);
    const Eigen::Map<const Eigen::VectorXd> right(force.data(), force.size());
    const Eigen::VectorXd multipliers = columns.colPivHouseholderQr().solve(right);
    CHECK((columns * multipliers - right).norm() < 1e-7 * right.norm());
    CHECK(multipliers.minCoeff() > -1e-7);
  }
}

TEST_CASE("resolver: an interrupted addition leaves the set unchanged") {
  std::srand(13);
  const Index count = 200;
  const Copy deformation(count);
  const Controls p = Controls::Random(count, 3);
  const CoupledMetric metric(coupled_gram(count).inverse());
  const std::vector<Stiv> first = random_stivs(20, count), more = random_stivs(100, count);
  const Execution execution(1);
  ConstraintSet set;
  add_constraints(set, first, deformation, p, metric, p, execution);
  const Controls before = set.project(p, metric, p, execution);
  for (const int allowed : {0, 1, 3, 6}) {
    Execution interrupted(1);
    interrupted.cancel_when([left = allowed]() mutable { return left-- <= 0; });
    CHECK_THROWS_AS(add_constraints(set, more, deformation, p, metric, p, interrupted), Interrupted);
    CHECK(set.size() == 20);
    CHECK((set.project(p, metric, p, execution) - before).norm() < 1e-9);
  }
}

TEST_CASE("resolver: equations hold for all constraints, also for inactive ones") {
  Controls p = Controls::Zero(2, 3);
  const std::vector<Stiv> stivs{half_space(0, Vector3::UnitX(), -1), half_space(0, Vector3::UnitY(), 0.5),
                                half_space(0, Vector3::UnitX(), -1, 3)};  // the third repeats the first
  const Copy deformation(2);
  const DiagonalMetric metric(Eigen::VectorXd::Ones(2));
  ConstraintSet set;
  set.add(control_constraints(stivs, deformation, p, metric, p), Execution(1));
  const Controls met = set.project_as_equations(p, metric, p, Execution(1));
  CHECK((met.row(0).transpose() - Vector3(1, -0.5, 0)).norm() < 1e-14);
  CHECK(met.row(1).norm() == 0);
  CHECK((resolve(stivs, p, Eigen::VectorXd::Ones(2)).row(0).transpose() - Vector3(1, 0, 0)).norm() < 1e-9);
}
