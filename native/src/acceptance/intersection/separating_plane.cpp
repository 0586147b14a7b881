// SPDX-License-Identifier: GPL-3.0-or-later
#include "acceptance/intersection/separating_plane.hpp"

#include <cmath>
#include <limits>

namespace stiv {

namespace {

// The error of a sum of at most three products of differences is at most ((1 + u)^5 - 1) times the sum of their
// magnitudes, u = 2^-53 [Higham 2002, section 3.1]. 8 u covers that and the rounding of the bound itself.
constexpr double rounding = 8 * 0x1p-53;

/// An interval that contains direction . (point - origin).
struct Height {
  double value;
  double error;

  Height(const Vector3& direction, const Vector3& point, const Vector3& origin) {
    const Vector3 term = direction.cwiseProduct(point - origin);
    value = term.sum();
    error = rounding * term.cwiseAbs().sum();
  }
  bool is_positive() const { return value > error; }
  bool is_negative() const { return value < -error; }
};

bool apart_along(const Vector3& direction, const Triangle& below, const Triangle& above) {
  const Vector3& origin = above[0];
  double top = -std::numeric_limits<double>::infinity(), bottom = -top, error = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Height low(direction, below[k], origin), high(direction, above[k], origin);
    top = std::max(top, low.value);
    bottom = std::min(bottom, high.value);
    error = std::max({error, low.error, high.error});
  }
  return bottom - top > 4 * error;
}

/// Side of a directed line in a projection; 0 if rounding makes it uncertain.
class Line {
 public:
  Line(const Vector3& from, const Vector3& to, int drop) : from_(from), x_((drop + 1) % 3), y_((drop + 2) % 3) {
    along_x_ = to[x_] - from[x_];
    along_y_ = to[y_] - from[y_];
  }
  int side(const Vector3& point) const {
    const double left = along_x_ * (point[y_] - from_[y_]);
    const double right = along_y_ * (point[x_] - from_[x_]);
    const double error = rounding * (std::abs(left) + std::abs(right));
    const double area = left - right;
    return (area > error) - (area < -error);
  }

 private:
  const Vector3& from_;
  int x_, y_;
  double along_x_, along_y_;
};

int largest_axis(const Vector3& vector) {
  int axis;
  vector.cwiseAbs().maxCoeff(&axis);
  return axis;
}

/// The axis along which a triangle's projection is largest.
int widest_projection(const Vector3& a, const Vector3& b, const Vector3& c) {
  return largest_axis((b - a).cross(c - a));
}

/// True if, projected along `drop`, the line of an edge of `a` separates `a` from `b`.
bool apart_over_edge(const Triangle& a, const Triangle& b, int drop) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Line line(a[k], a[(k + 1) % 3], drop);
    const int side = line.side(a[(k + 2) % 3]);
    if (side != 0 && line.side(b[0]) == -side && line.side(b[1]) == -side && line.side(b[2]) == -side) return true;
  }
  return false;
}

/// True if, projected along `drop`, the line of a side of `a` at the corner separates `a` from `b`.
bool apart_over_side(const Vector3& corner, const Segment& a, const Segment& b, int drop) {
  for (std::size_t k = 0; k < 2; ++k) {
    const Line line(corner, a[k], drop);
    const int side = line.side(a[1 - k]);
    if (side != 0 && line.side(b[0]) == -side && line.side(b[1]) == -side) return true;
  }
  return false;
}

}  // namespace

bool separated_by_plane(const Triangle& a, const Triangle& b) {
  const Vector3 direction = (b[0] + b[1] + b[2]) - (a[0] + a[1] + a[2]);
  if (apart_along(direction, a, b)) return true;
  return apart_over_edge(a, b, widest_projection(a[0], a[1], a[2])) ||
         apart_over_edge(b, a, widest_projection(b[0], b[1], b[2]));
}

bool separated_at_corner(const Vector3& corner, const Segment& a, const Segment& b) {
  const Vector3 direction = (b[0] + b[1]) - (a[0] + a[1]);
  if (Height(direction, a[0], corner).is_negative() && Height(direction, a[1], corner).is_negative() &&
      Height(direction, b[0], corner).is_positive() && Height(direction, b[1], corner).is_positive())
    return true;
  return apart_over_side(corner, a, b, widest_projection(corner, a[0], a[1])) ||
         apart_over_side(corner, b, a, widest_projection(corner, b[0], b[1]));
}

bool separated_at_edge(const Segment& edge, const Vector3& a, const Vector3& b) {
  const Line line(edge[0], edge[1], widest_projection(edge[0], edge[1], a));
  return line.side(a) * line.side(b) < 0;
}

}  // namespace stiv
