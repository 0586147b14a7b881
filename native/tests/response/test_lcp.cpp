// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <limits>
#include <random>

#include "stiv/error.hpp"
#include "stiv/response/lcp.hpp"
#include "vector_targets.hpp"

using namespace stiv;

namespace {

double infeasibility(const Eigen::MatrixXd& B, const Eigen::VectorXd& b, const Eigen::VectorXd& x) {
  const Eigen::VectorXd slack = B * x + b;
  return std::max({-x.minCoeff(), -slack.minCoeff(), x.cwiseProduct(slack).cwiseAbs().maxCoeff()});
}

/// Tries all 2^n sets of rows that may carry a multiplier, and returns the solution with the least violation.
Eigen::VectorXd solve_by_enumeration(const Eigen::MatrixXd& B, const Eigen::VectorXd& b) {
  const auto n = static_cast<int>(b.size());
  Eigen::VectorXd best;
  double least = std::numeric_limits<double>::infinity();
  for (int set = 0; set < 1 << n; ++set) {
    std::vector<int> active;
    for (int k = 0; k < n; ++k)
      if (set >> k & 1) active.push_back(k);
    Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
    const Eigen::MatrixXd rows = B(active, active);
    const Eigen::VectorXd missing = -b(active);
    if (!active.empty()) x(active) = rows.completeOrthogonalDecomposition().solve(missing).eval();
    const double violation = infeasibility(B, b, x);
    if (violation < least) {
      least = violation;
      best = x;
    }
  }
  REQUIRE(least < 1e-9);
  return best;
}

}  // namespace

TEST_CASE("lcp: equal to the enumeration of all complementarity cases") {
  std::srand(3);
  for (int trial = 0; trial < 60; ++trial) {
    const int n = 1 + trial % 7;
    const Eigen::MatrixXd A = Eigen::MatrixXd::Random(n, n + 2);
    const Eigen::MatrixXd B = A * A.transpose();
    const Eigen::VectorXd b = Eigen::VectorXd::Random(n);
    LcpOptions precise;
    precise.max_sweeps = 100000;
    precise.tolerance = 1e-14;
    const Eigen::VectorXd x = solve_lcp(B, b, {}, precise);
    CHECK((x - solve_by_enumeration(B, b)).norm() < 1e-7 * (1 + x.norm()));
  }
}

TEST_CASE("lcp: the same bits for every vector target") {
  std::srand(8);
  const Eigen::MatrixXd A = Eigen::MatrixXd::Random(61, 40);
  const Eigen::MatrixXd B = A * A.transpose();
  const Eigen::VectorXd b = A * Eigen::VectorXd::Random(40);
  const auto results = for_each_vector_target([&] { return solve_lcp(B, b); });
  for (const Eigen::VectorXd& x : results) CHECK(x == results.front());
}

TEST_CASE("lcp: repeated rows have a unique correction without unique multipliers") {
  std::srand(5);
  for (int trial = 0; trial < 30; ++trial) {
    Eigen::MatrixXd A = Eigen::MatrixXd::Random(6, 9);
    A.row(4) = A.row(1);
    A.row(5) = 2 * A.row(2);
    Eigen::VectorXd b = Eigen::VectorXd::Random(6);
    b[4] = b[1];
    b[5] = 2 * b[2];
    const Eigen::MatrixXd B = A * A.transpose();
    const Eigen::VectorXd x = solve_lcp(B, b, {}, {.max_sweeps = 100000, .tolerance = 1e-14});
    CHECK(infeasibility(B, b, x) < 1e-9);
    CHECK((A.transpose() * (x - solve_by_enumeration(B, b))).norm() < 1e-6);
  }
}

TEST_CASE("lcp: rows without a positive diagonal are ignored, contradictions terminate") {
  Eigen::MatrixXd B(3, 3);
  B << 0, 0, 0, 0, 2, 0, 0, 0, 1;
  CHECK(solve_lcp(B, Eigen::Vector3d(-1, -1, 4)) == Eigen::Vector3d(0, 0.5, 0));
  Eigen::MatrixXd opposite(2, 2);
  opposite << 1, -1, -1, 1;
  CHECK(solve_lcp(opposite, Eigen::Vector2d(-1, -1)).allFinite());
  CHECK(solve_lcp(Eigen::MatrixXd(0, 0), Eigen::VectorXd(0)).size() == 0);
}

TEST_CASE("lcp: the solution as a first guess is returned at once") {
  std::srand(9);
  const Eigen::MatrixXd A = Eigen::MatrixXd::Random(5, 8);
  const Eigen::MatrixXd B = A * A.transpose();
  const Eigen::VectorXd b = Eigen::VectorXd::Random(5);
  const Eigen::VectorXd x = solve_lcp(B, b, {}, {.max_sweeps = 100000, .tolerance = 1e-15});
  CHECK((solve_lcp(B, b, x, {.max_sweeps = 1}) - x).norm() < 1e-12);
}

TEST_CASE("lcp: can be cancelled") {
  Execution execution(1);
  execution.request_cancel();
  CHECK_THROWS_AS(solve_lcp(Eigen::MatrixXd::Identity(1, 1), Eigen::VectorXd::Ones(1), {}, {.execution = &execution}),
                  Interrupted);
}
