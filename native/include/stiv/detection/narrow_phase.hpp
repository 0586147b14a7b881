// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <optional>

#include "stiv/detection/event.hpp"
#include "stiv/detection/proximity.hpp"

namespace stiv {

/// Four vertices moving linearly over a step, in the order of Event::vertices.
struct PairMotion {
  std::array<Vector3, 4> start;
  std::array<Vector3, 4> end;
  std::optional<std::array<Vector3, 4>> reference = std::nullopt;  ///< as Proximity::reference; none: the start
};

/// A contact of a known pair.
struct Contact {
  double time = 0;
  std::array<double, 4> weights{};
  Vector3 normal = Vector3::Zero();
  double start_distance = 0;
  PairClearance clearance;
};

/// The first time at which the pair is within `proximity.clearance(d).threshold`, d its distance at the reference, or
/// nothing if it never is. A pair that starts nearer than that may not come nearer. Conservative: no contact is missed,
/// and no time is later than the true one. The distance at a report exceeds the threshold by at most 10 %. Distances
/// are those of the clamped primitives (edges and vertices of a triangle included).
///
/// A pair that touches at the start is a contact at 0 unless a plane shows that it separates or slides. A pair that
/// moves as a whole (no displacement relative to its first vertex) is never a contact.
/// @param latest the search ends at this time; contacts up to it do not depend on it
std::optional<Contact> first_contact(EventKind kind, const PairMotion& motion, Proximity proximity, double latest = 1);

/// The same as published, for comparison [P4.1, P5.2]: not conservative. The roots in time are those of a polynomial
/// that is zero where vertex and plane (or the lines of both edges) are at the threshold. It has degree six, or three
/// without a separation [Provot 1997]. The contact is the first root at which the primitives themselves are that close.
/// The time is 1/100 early. Contacts on edges and corners at a distance, and within a common plane, are missed or late.
std::optional<Contact> first_contact_by_polynomial(EventKind kind, const PairMotion& motion, Proximity proximity,
                                                   double latest = 1);

/// Time at which the pair first is within `separation` (>= 0), never later than the true time; 0 if it starts within
/// it; infinity (`never`) if it never does.
double time_of_impact(EventKind kind, const PairMotion& motion, double separation);

}  // namespace stiv
