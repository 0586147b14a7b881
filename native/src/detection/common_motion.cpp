// SPDX-License-Identifier: GPL-3.0-or-later
#include "detection/common_motion.hpp"

namespace stiv {

namespace {

constexpr double much_smaller = 1.0 / 4;

struct Sums {
  Vector3 displacement = Vector3::Zero();
  double square = 0;
};

Sums sums_of(const Positions& from, const Positions& to, Index begin, Index end) {
  Sums sums;
  for (Index vertex = begin; vertex < end; ++vertex) {
    const Vector3 displacement = to.row(vertex) - from.row(vertex);
    sums.displacement += displacement;
    sums.square += displacement.squaredNorm();
  }
  return sums;
}

}  // namespace

Vector3 common_motion(const Positions& start, const Positions& end, const Execution& execution) {
  constexpr Index chunk_size = 4096;
  const auto count = static_cast<Index>(start.rows());
  std::vector<Sums> parts(static_cast<std::size_t>(Execution::chunk_count(count, chunk_size)));
  execution.for_chunks(count, chunk_size, [&](Index first, Index last, Index chunk) {
    parts[static_cast<std::size_t>(chunk)] = sums_of(start, end, first, last);
  });
  Sums whole;
  for (const Sums& part : parts) {
    whole.displacement += part.displacement;
    whole.square += part.square;
  }
  const Vector3 mean = whole.displacement / count;
  const double left = whole.square - count * mean.squaredNorm();
  return left <= much_smaller * whole.square ? mean : Vector3(Vector3::Zero());
}

}  // namespace stiv
