// SPDX-License-Identifier: GPL-3.0-or-later
#include "volumes/published_gradient.hpp"

#include <algorithm>
#include <cmath>

namespace stiv {

namespace {

/// Sine below which rounding determines the plane of two directions: derivatives are 0.
constexpr double least_sine = 1e-6;

/// The contact's four vertices and its frame. For both kinds of contact, the separation vector is
/// apart - alpha u - beta v, orthogonal to u and v, which span the face or are the two edges.
struct ContactMotion {
  std::array<Vector3, 4> at;            ///< positions at the time of contact
  std::array<Vector3, 4> displacement;  ///< Dq_k
  double time = 0;                      ///< of the contact itself, before the retreat
  double approach = 0;                  ///< n . Drho with the event's normal
};

struct Frame {
  Vector3 u, v, apart;
  double alpha = 0, beta = 0;
};

/// Derivatives of a scalar with respect to the three vectors of a frame.
struct FrameGradient {
  Vector3 u = Vector3::Zero(), v = Vector3::Zero(), apart = Vector3::Zero();
};

bool is_vertex_face(const Event& event) { return event.kind == EventKind::vertex_face; }

/// The time at which n . sum_k w_k x_k is the pair's threshold, or its smaller distance at the start.
double contact_time(const Event& event, const Positions& start, double approach) {
  if (approach == 0) return event.time;
  const double distance = std::min(event.clearance.threshold, event.start_distance);
  return std::clamp((distance - event.normal.dot(weighted_sum(event, start))) / approach, 0.0, 1.0);
}

ContactMotion motion_of(const Event& event, const Positions& start, const Positions& end) {
  ContactMotion motion;
  for (std::size_t k = 0; k < 4; ++k)
    motion.displacement[k] = (end.row(event.vertices[k]) - start.row(event.vertices[k])).transpose();
  for (std::size_t k = 0; k < 4; ++k) motion.approach += event.weights[k] * event.normal.dot(motion.displacement[k]);
  motion.time = contact_time(event, start, motion.approach);
  for (std::size_t k = 0; k < 4; ++k)
    motion.at[k] = start.row(event.vertices[k]).transpose() + motion.time * motion.displacement[k];
  return motion;
}

Frame frame_of(const Event& event, const std::array<Vector3, 4>& x) {
  const auto& w = event.weights;
  if (is_vertex_face(event)) return {x[2] - x[1], x[3] - x[1], x[0] - x[1], -w[2], -w[3]};
  return {x[1] - x[0], x[3] - x[2], x[0] - x[2], -w[1], -w[3]};
}

/// The gradient of a scalar of the frame with respect to the four positions.
CornerGradients by_corners(const Event& event, const FrameGradient& g) {
  if (is_vertex_face(event)) return {g.apart, -g.u - g.v - g.apart, g.u, g.v};
  return {g.apart - g.u, g.u, -g.apart - g.v, g.v};
}

/// Derivative of n . r with respect to the frame; n is the unit normal of u and v on the side of `normal`, and r is
/// constant.
FrameGradient of_normal(const Frame& frame, const Vector3& normal, const Vector3& r) {
  const Vector3 product = frame.u.cross(frame.v);
  const double length = std::copysign(product.norm(), product.dot(normal));
  const Vector3 within = (r - normal.dot(r) * normal) / length;
  return {frame.v.cross(within), within.cross(frame.u), Vector3::Zero()};
}

/// Derivative of a alpha + b beta with respect to the frame, from u . d = v . d = 0 for the separation vector d.
FrameGradient of_weights(const Frame& frame, double a, double b) {
  const double uu = frame.u.squaredNorm(), vv = frame.v.squaredNorm(), uv = frame.u.dot(frame.v);
  const double determinant = uu * vv - uv * uv;
  const double y = (vv * a - uv * b) / determinant, z = (uu * b - uv * a) / determinant;
  const Vector3 separation = frame.apart - frame.alpha * frame.u - frame.beta * frame.v;
  const Vector3 m = y * frame.u + z * frame.v;
  return {y * separation - frame.alpha * m, z * separation - frame.beta * m, m};
}

/// Derivatives of n . Dr with respect to alpha and beta, through the side's |w_k|.
std::array<double, 2> slopes_by_weights(const Event& event, const ContactSide& side, const Vector3& normal,
                                        const ContactMotion& motion) {
  const auto along = [&](std::size_t to, std::size_t from) {
    return normal.dot(motion.displacement[to] - motion.displacement[from]);
  };
  if (is_vertex_face(event)) return side.begin == 0 ? std::array{0.0, 0.0} : std::array{along(2, 1), along(3, 1)};
  return side.begin == 0 ? std::array{-along(1, 0), 0.0} : std::array{0.0, along(3, 2)};
}

bool spans_a_plane(const Frame& frame) {
  return frame.u.cross(frame.v).norm() > least_sine * frame.u.norm() * frame.v.norm();
}

/// Derivative of n . Dr with respect to the positions at the time of contact, through n and the weights.
CornerGradients by_contact(const Event& event, const ContactSide& side, const Vector3& normal,
                           const ContactMotion& motion) {
  const Frame frame = frame_of(event, motion.at);
  if (!spans_a_plane(frame)) return by_corners(event, {});
  const auto [a, b] = slopes_by_weights(event, side, normal, motion);
  const FrameGradient turning = of_normal(frame, normal, side.displacement), sliding = of_weights(frame, a, b);
  return by_corners(event, {turning.u + sliding.u, turning.v + sliding.v, turning.apart + sliding.apart});
}

/// dt/dq_k = -t w_k n / (n . Drho): the appendix's w_k n with its scale.
Vector3 by_time(const Event& event, const ContactMotion& motion, std::size_t k) {
  if (motion.approach == 0) return Vector3::Zero();
  return -motion.time * event.weights[k] / motion.approach * event.normal;
}

}  // namespace

CornerGradients frozen_gradient(const Event& event, const ContactSide& side, const Vector3& normal) {
  CornerGradients gradients;
  gradients.fill(Vector3::Zero());
  for (int corner = side.begin; corner < side.end; ++corner) {
    const auto k = static_cast<std::size_t>(corner);
    gradients[k] = (1 - event.time) * std::abs(event.weights[k]) * normal;
  }
  return gradients;
}

CornerGradients whole_gradient(const Event& event, const ContactSide& side, const Vector3& normal,
                               const Positions& start, const Positions& end) {
  const ContactMotion motion = motion_of(event, start, end);
  const CornerGradients contact = by_contact(event, side, normal, motion);
  double turning = 0;  // d (n . Dr) / dt by the motion of the contact
  for (std::size_t k = 0; k < 4; ++k) turning += contact[k].dot(motion.displacement[k]);
  const double remaining = 1 - event.time;
  const double reported = event.time > 0 ? normal.dot(side.displacement) : 0;  // a time of 0 is constant
  CornerGradients gradients = frozen_gradient(event, side, normal);
  for (std::size_t k = 0; k < 4; ++k)
    gradients[k] += remaining * motion.time * contact[k] + (remaining * turning - reported) * by_time(event, motion, k);
  return gradients;
}

}  // namespace stiv
