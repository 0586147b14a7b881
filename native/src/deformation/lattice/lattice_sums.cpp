// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/lattice/lattice_sums.hpp"

#include <algorithm>
#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "deformation/lattice/lattice_sums.cpp"
#include "vector/foreach_target.hpp"  // first: it includes this file again

#include "vector/doubles-inl.hpp"

#ifndef STIV_LATTICE_SUMS_TYPES
#define STIV_LATTICE_SUMS_TYPES

namespace stiv {

/// Input and output of the sums. Points are x, y, z; some numbers follow the last one.
struct LatticeProduct {
  const Index* starts;
  const double* weights;
  const double* points;
  std::ptrdiff_t row, layer;  ///< numbers from a point to the next along v, and along w
  const double* offset;       ///< (n, 3) added to the sums; null: nothing
  const Index* vertices;      ///< of the sums; null: all
  const Index* places;        ///< rows of the sums; null: in order
  double* sums;               ///< (n, 3)
};

}  // namespace stiv

#endif

HWY_BEFORE_NAMESPACE();
namespace stiv::HWY_NAMESPACE {

constexpr std::size_t four_points = 12;  // numbers of the four that follow each other along u
constexpr std::size_t lane_count = hn::MaxLanes(Doubles());
constexpr std::size_t vectors = lane_count == 1 ? 4 : lane_count == 8 ? 2 : 3;  // few enough for the registers

/// Sums along v and w of some of the numbers of four points.
HWY_INLINE void add_rows(const LatticeProduct& p, const double* first, const double* weights, double* sums) {
  const Doubles d;
  Lanes whole[vectors];
  for (std::size_t k = 0; k < vectors; ++k) whole[k] = hn::Zero(d);
  for (std::size_t c = 0; c < 4; ++c) {
    const double* row = first + static_cast<std::ptrdiff_t>(c) * p.layer;
    Lanes layer[vectors];
    for (std::size_t k = 0; k < vectors; ++k)
      layer[k] = hn::Mul(hn::Set(d, weights[4]), hn::LoadU(d, row + k * lane_count));
    for (std::size_t b = 1; b < 4; ++b) {
      row += p.row;
      const Lanes along_v = hn::Set(d, weights[4 + b]);
      for (std::size_t k = 0; k < vectors; ++k)
        layer[k] = hn::Add(layer[k], hn::Mul(along_v, hn::LoadU(d, row + k * lane_count)));
    }
    const Lanes along_w = hn::Set(d, weights[8 + c]);
    for (std::size_t k = 0; k < vectors; ++k) whole[k] = hn::Add(whole[k], hn::Mul(along_w, layer[k]));
  }
  for (std::size_t k = 0; k < vectors; ++k) hn::StoreU(whole[k], d, sums + k * lane_count);
}

void add_points(const LatticeProduct& p, Index begin, Index end) {
  for (Index k = begin; k < end; ++k) {
    const Index vertex = p.vertices == nullptr ? k : p.vertices[k];
    const double* const first = p.points + 3 * static_cast<std::ptrdiff_t>(p.starts[vertex]);
    const double* const weights = p.weights + 12 * static_cast<std::ptrdiff_t>(vertex);
    double values[four_points + lane_count];
    for (std::size_t done = 0; done < four_points; done += vectors * lane_count)
      add_rows(p, first + done, weights, values + done);
    double* const sum = p.sums + 3 * static_cast<std::ptrdiff_t>(p.places == nullptr ? k : p.places[k]);
    for (std::size_t axis = 0; axis < 3; ++axis)
      sum[axis] = (weights[0] * values[axis] + weights[1] * values[3 + axis]) +
                  (weights[2] * values[6 + axis] + weights[3] * values[9 + axis]);
    if (p.offset == nullptr) continue;
    const double* const offset = p.offset + 3 * static_cast<std::ptrdiff_t>(vertex);
    for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += offset[axis];
  }
}

}  // namespace stiv::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace stiv {

LatticeSums::LatticeSums(const std::array<LatticeAxis, 3>& axes, const Positions& places,
                         const Eigen::VectorXd& factors) {
  const auto count = static_cast<Index>(places.rows());
  std::vector<std::array<Index, 3>> first(static_cast<std::size_t>(count));
  weights_.reserve(12 * first.size());
  for (Index vertex = 0; vertex < count; ++vertex)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const AxisWeights along = axis_weights(axes[axis], places(vertex, static_cast<Index>(axis)));
      for (const double weight : along.weight) weights_.push_back(axis == 2 ? weight * factors[vertex] : weight);
      first[at(vertex)][axis] = along.first;
    }
  for (std::size_t axis = 0; axis < 3 && count > 0; ++axis) {
    const auto along = [&](const auto& a, const auto& b) { return a[axis] < b[axis]; };
    const auto [least, most] = std::minmax_element(first.begin(), first.end(), along);
    axes_[axis] = {(*least)[axis], (*most)[axis] - (*least)[axis] + 4};
  }
  for (Index w = 0; w < axes_[2].count; ++w)
    for (Index v = 0; v < axes_[1].count; ++v)
      for (Index u = 0; u < axes_[0].count; ++u)
        points_.push_back((axes[2].point(axes_[2].first + w) * axes[1].count + axes[1].point(axes_[1].first + v)) *
                              axes[0].count +
                          axes[0].point(axes_[0].first + u));
  for (const std::array<Index, 3>& at : first)
    starts_.push_back(((at[2] - axes_[2].first) * axes_[1].count + at[1] - axes_[1].first) * axes_[0].count + at[0] -
                      axes_[0].first);
}

Positions LatticeSums::sum(const Controls& p, const Execution& execution) const {
  Positions sums(vertex_count(), 3);
  put(p, {}, sums, execution);
  return sums;
}

void LatticeSums::put(const Controls& p, const LatticeRows& rows, Positions& sums, const Execution& execution) const {
  constexpr Index rows_per_chunk = 512;
  constexpr std::size_t read_beyond = 4;  // numbers, by vectors of eight
  std::vector<double> points(3 * points_.size() + read_beyond, 0);
  for (std::size_t place = 0; place < points_.size(); ++place)
    for (std::size_t axis = 0; axis < 3; ++axis) points[3 * place + axis] = p(points_[place], static_cast<Index>(axis));
  const auto numbers = [](std::span<const Index> some) { return some.empty() ? nullptr : some.data(); };
  const std::ptrdiff_t row = 3 * static_cast<std::ptrdiff_t>(axes_[0].count);
  const LatticeProduct product{starts_.data(),
                               weights_.data(),
                               points.data(),
                               row,
                               row * axes_[1].count,
                               rows.offset == nullptr ? nullptr : rows.offset->data(),
                               numbers(rows.vertices),
                               numbers(rows.places),
                               sums.data()};
  const Index count = rows.vertices.empty() ? vertex_count() : static_cast<Index>(rows.vertices.size());
  execution.for_chunks(count, rows_per_chunk, [&](Index begin, Index end, Index) {
    STIV_FOR_VECTOR_TARGET(add_points)(product, begin, end);
  });
}

}  // namespace stiv
#endif
