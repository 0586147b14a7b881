// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include "detection/motions.hpp"
#include "detection/reference.hpp"
#include "stiv/detection/narrow_phase.hpp"

using namespace stiv;

namespace {

constexpr EventKind both_kinds[] = {EventKind::vertex_face, EventKind::edge_edge};

bool within_both(const Contact& contact, double margin) {
  for (const double weight : contact.weights)
    if (std::abs(weight) < margin) return false;
  return true;
}

}  // namespace

TEST_CASE("polynomial: contacts within both primitives come out 1/100 before the time found by bisection") {
  MotionMaker make(31);
  for (const double separation : {0.0, 0.05}) {
    int seen = 0;
    for (int trial = 0; trial < 1500; ++trial)
      for (const EventKind kind : both_kinds) {
        const PairMotion motion = make.make(MotionMaker::general);
        const auto contact = first_contact_by_polynomial(kind, motion, {separation, 0.5});
        const auto conservative = first_contact(kind, motion, {separation, 0.5});
        if (contact) CHECK(conservative);
        // The polynomial must find the first contact unless it is near an edge, end or corner.
        if (!conservative || !within_both(*conservative, 0.05) || conservative->time == 0) continue;
        const double d0 = conservative->start_distance, threshold = d0 < separation ? 0.5 * d0 : separation;
        const auto truth = reference::first_time(kind, motion, threshold + 1e-9, 1e-10L);
        if (!std::isfinite(static_cast<double>(truth.time))) continue;
        REQUIRE(contact);
        CHECK(contact->time == doctest::Approx(std::max(0.0, static_cast<double>(truth.time) - 0.01)).epsilon(1e-6));
        CHECK(contact->normal.dot(conservative->normal) > 0.99);
        ++seen;
      }
    CHECK(seen > 100);
  }
}

TEST_CASE("polynomial: motion within a plane has no contact, common motion neither") {
  MotionMaker make(37);
  for (int trial = 0; trial < 200; ++trial)
    for (const EventKind kind : both_kinds) {
      PairMotion motion = make.make(MotionMaker::coplanar);
      const auto contact = first_contact_by_polynomial(kind, motion, {0, 0.5});
      if (contact) CHECK(contact->time == 0);  // it touches at the start
      for (std::size_t k = 0; k < 4; ++k) motion.end[k] = motion.start[k] + Vector3(1, 2, 3);
      CHECK_FALSE(first_contact_by_polynomial(kind, motion, {0.5, 0.5}));
    }
}

TEST_CASE("polynomial: contacts after the latest time are left out") {
  PairMotion motion;
  motion.start = {Vector3(0.25, 0.25, 1), Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(0, 1, 0)};
  motion.end = motion.start;
  motion.end[0][2] = -1;
  const auto contact = first_contact_by_polynomial(EventKind::vertex_face, motion, {0.2, 0.5});
  REQUIRE(contact);
  CHECK(contact->time == doctest::Approx(0.39));
  CHECK(contact->normal.isApprox(Vector3::UnitZ()));
  CHECK(first_contact_by_polynomial(EventKind::vertex_face, motion, {0.2, 0.5}, 0.4));
  CHECK_FALSE(first_contact_by_polynomial(EventKind::vertex_face, motion, {0.2, 0.5}, 0.3));
}
