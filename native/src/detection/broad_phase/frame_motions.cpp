// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/broad_phase/frame_motions.hpp"

#include <algorithm>

namespace stiv {

namespace {

constexpr double much_smaller = 1.0 / 4;
constexpr Index enough = 1024;  // vertices in the samples of all bodies
constexpr Index enough_of_a_body = 32;
constexpr double several_edges = 2, many_edges = 4;

/// Displacements of some vertices.
class Sums {
 public:
  void add(const Vector3& displacement) {
    sum_ += displacement;
    square_ += displacement.squaredNorm();
    ++count_;
  }

  Vector3 mean_or_zero() const {
    if (count_ == 0) return Vector3::Zero();
    const Vector3 mean = sum_ / count_;
    const double left = square_ - count_ * mean.squaredNorm();
    return left <= much_smaller * square_ ? mean : Vector3(Vector3::Zero());
  }

 private:
  Vector3 sum_ = Vector3::Zero();
  double square_ = 0;
  Index count_ = 0;
};

}  // namespace

Vector3 common_motion(const PositionsView& start, const PositionsView& end) {
  const auto all = static_cast<Index>(start.rows());
  Sums sums;
  for (Index vertex = 0; vertex < all; vertex += all / enough + 1) sums.add(end.row(vertex) - start.row(vertex));
  return sums.mean_or_zero();
}

FrameChooser::FrameChooser(const Surface& surface, Index large_body) : body_count_(surface.bodies().size()) {
  const auto bodies = static_cast<Index>(body_count_);
  if (bodies < 2) return;
  std::vector<Index> counts(body_count_, 0), seen(body_count_, 0), sample_of(body_count_, -1);
  for (Index vertex = 0; vertex < surface.vertex_count(); ++vertex) ++counts[surface.body_of(vertex)];
  for (Index body = 0; body < bodies; ++body) {
    if (counts[body] == 0 || counts[body] < large_body || !surface.bodies_meet(body, body)) continue;
    sample_of[body] = static_cast<Index>(samples_.size());
    samples_.push_back({body, {}, {}});
  }
  if (samples_.empty()) return;
  const Index most = std::max(enough / static_cast<Index>(samples_.size()), enough_of_a_body);
  for (Index vertex = 0; vertex < surface.vertex_count(); ++vertex) {
    const Index body = surface.body_of(vertex), number = seen[body]++;
    if (sample_of[body] < 0 || number % (counts[body] / most + 1) != 0) continue;
    const Index* const neighbours = surface.neighbours_begin(vertex);
    samples_[sample_of[body]].vertices.push_back(vertex);
    samples_[sample_of[body]].neighbours.push_back(neighbours < surface.neighbours_end(vertex) ? *neighbours : vertex);
  }
}

double FrameChooser::edge_square(const Sample& sample, const PositionsView& start) {
  double sum = 0;
  for (std::size_t k = 0; k < sample.vertices.size(); ++k)
    sum += (start.row(sample.neighbours[k]) - start.row(sample.vertices[k])).squaredNorm();
  return sum / static_cast<double>(sample.vertices.size());
}

FrameMotions FrameChooser::choose(const PositionsView& start, const PositionsView& end) const {
  FrameMotions motions{common_motion(start, end), {}};
  for (const Sample& sample : samples_) {
    Sums sums;
    for (const Index vertex : sample.vertices)
      sums.add(Vector3(end.row(vertex)) - Vector3(start.row(vertex)) - motions.common);
    const Vector3 own = sums.mean_or_zero();
    const double edges = own.squaredNorm() / edge_square(sample, start);  // squared
    if (!(edges > several_edges * several_edges)) continue;
    motions.go_far = motions.go_far || edges > many_edges * many_edges;
    if (motions.of_bodies.empty()) motions.of_bodies.assign(body_count_, motions.common);
    motions.of_bodies[sample.body] += own;
  }
  return motions;
}

}  // namespace stiv
