// SPDX-License-Identifier: GPL-3.0-or-later
// Derivation: docs/mathematics.md, "Stars".
#include "acceptance/stars.hpp"

#include <algorithm>
#include <array>
#include <span>

namespace stiv {

namespace {

/// Stars of more triangles are left to the tests of pairs, which are more work by then in any case.
constexpr std::size_t most_triangles = 32;

// A determinant of two differences and an exact direction: each of its six products carries at most seven roundings.
// 32 u times a bound of their magnitudes covers that, and the rounding of the bound itself.
constexpr double rounding = 32 * 0x1p-53;
// More than what underflow can take from a determinant.
constexpr double underflow = 0x1p-960;

std::size_t at(Index index) { return static_cast<std::size_t>(index); }

/// The side of a triangle opposite to a vertex, in its direction of turning.
struct Spoke {
  Index from, to;
};

/// Spokes of each vertex, in compressed rows.
struct SpokeTable {
  std::vector<std::size_t> start;
  std::vector<Spoke> spokes;

  SpokeTable(const std::vector<std::array<Index, 3>>& triangles, Index vertex_count) : start(at(vertex_count) + 2, 0) {
    for (const auto& corners : triangles)
      for (const Index corner : corners) ++start[at(corner) + 2];
    for (std::size_t k = 2; k < start.size(); ++k) start[k] += start[k - 1];
    spokes.resize(3 * triangles.size());
    for (const auto& [a, b, c] : triangles) {
      spokes[start[at(a) + 1]++] = {b, c};
      spokes[start[at(b) + 1]++] = {c, a};
      spokes[start[at(c) + 1]++] = {a, b};
    }
  }
  std::span<Spoke> of(Index vertex) {
    return {spokes.data() + start[at(vertex)], spokes.data() + start[at(vertex) + 1]};
  }
};

/// Puts spokes into the order in which each begins where the one before ends. False if they are not one such chain, in
/// which no vertex begins or ends two.
bool chain(std::span<Spoke> spokes) {
  if (spokes.empty() || spokes.size() > most_triangles) return false;
  for (std::size_t k = 0; k < spokes.size(); ++k)
    for (std::size_t other = 0; other < spokes.size(); ++other)
      if (other != k && (spokes[k].from == spokes[other].from || spokes[k].to == spokes[other].to)) return false;
  const auto begins_chain = [&](const Spoke& spoke) {
    return std::none_of(spokes.begin(), spokes.end(), [&](const Spoke& before) { return before.to == spoke.from; });
  };
  const auto first = std::find_if(spokes.begin(), spokes.end(), begins_chain);
  if (first != spokes.end()) std::swap(*first, spokes.front());
  for (std::size_t k = 0; k + 1 < spokes.size(); ++k) {
    const auto next = std::find_if(spokes.begin() + static_cast<std::ptrdiff_t>(k) + 1, spokes.end(),
                                   [&](const Spoke& spoke) { return spoke.from == spokes[k].to; });
    if (next == spokes.end()) return false;
    std::swap(*next, spokes[k + 1]);
  }
  return true;
}

double largest(const Vector3& vector) { return vector.cwiseAbs().maxCoeff(); }

/// Signs of the turns between directions from a vertex, seen along `view`; 0 where rounding leaves them open.
struct Turns {
  Vector3 view;
  double scale;

  explicit Turns(const Vector3& along) : view(along), scale(rounding * 6 * largest(along)) {}

  int sign(const Vector3& from, double from_size, const Vector3& to, double to_size) const {
    const double turn = view.dot(from.cross(to));
    const double error = scale * from_size * to_size + underflow;
    return (turn > error) - (turn < -error);
  }
};

}  // namespace

Stars::Stars(const std::vector<std::array<Index, 3>>& triangles, Index vertex_count) {
  SpokeTable table(triangles, vertex_count);
  start_.reserve(at(vertex_count) + 1);
  rims_.reserve(table.spokes.size() + at(vertex_count));
  for (Index vertex = 0; vertex < vertex_count; ++vertex) {
    start_.push_back(static_cast<Index>(rims_.size()));
    const std::span<Spoke> spokes = table.of(vertex);
    if (spokes.size() < 2 || !chain(spokes)) continue;  // of one triangle alone, nothing is to be left out
    for (const Spoke& spoke : spokes) rims_.push_back(spoke.from);
    rims_.push_back(spokes.back().to);
  }
  start_.push_back(static_cast<Index>(rims_.size()));
}

bool Stars::proven_free(Index vertex, const PositionsView& q) const {
  const std::span<const Index> rim = this->rim(vertex);
  if (rim.empty()) return false;
  const std::size_t count = rim.size() - 1;
  const bool closed = rim.front() == rim.back();

  std::array<Vector3, most_triangles + 1> arm;
  std::array<double, most_triangles + 1> size;
  for (std::size_t k = 0; k <= count; ++k) {
    arm[k] = (q.row(rim[k]) - q.row(vertex)).transpose();
    size[k] = largest(arm[k]);
  }
  Vector3 view = Vector3::Zero();
  for (std::size_t k = 0; k < count; ++k) view += arm[k].cross(arm[k + 1]);

  const Turns turns(view);
  int before = 1;  // of the turn from the first arm to arm k: the first triangle begins there
  for (std::size_t k = 0; k < count; ++k) {
    if (turns.sign(arm[k], size[k], arm[k + 1], size[k + 1]) <= 0) return false;
    const int after = turns.sign(arm[0], size[0], arm[k + 1], size[k + 1]);
    // Does triangle k hold the first arm, on which it neither begins nor ends?
    const bool on_it = k == 0 || (closed && k + 1 == count);
    if (!on_it && before <= 0 && after >= 0) return false;
    before = after;
  }
  return true;
}

std::vector<unsigned char> Stars::find_free(const PositionsView& q, const std::vector<unsigned char>& moved,
                                            const Execution& execution) const {
  constexpr Index chunk_size = 4096;
  std::vector<unsigned char> free(at(static_cast<Index>(q.rows())), 0);
  const auto has_moved = [&](Index vertex) { return moved[at(vertex)] != 0; };
  execution.for_chunks(static_cast<Index>(q.rows()), chunk_size, [&](Index begin, Index end, Index) {
    for (Index vertex = begin; vertex < end; ++vertex) {
      const std::span<const Index> around = rim(vertex);
      if (moved.empty() || has_moved(vertex) || std::any_of(around.begin(), around.end(), has_moved))
        free[at(vertex)] = proven_free(vertex, q);
    }
  });
  return free;
}

std::span<const Index> Stars::rim(Index vertex) const {
  const auto begin = rims_.begin() + start_[at(vertex)], end = rims_.begin() + start_[at(vertex) + 1];
  return {begin, end};
}

}  // namespace stiv
