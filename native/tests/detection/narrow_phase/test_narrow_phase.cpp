// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include "detection/motions.hpp"
#include "detection/reference.hpp"
#include "stiv/detection/distance.hpp"
#include "stiv/detection/narrow_phase.hpp"

using namespace stiv;

namespace {

constexpr EventKind both_kinds[] = {EventKind::vertex_face, EventKind::edge_edge};

double extent(const PairMotion& motion) {
  double largest = 0;
  for (std::size_t k = 0; k < 4; ++k)
    largest = std::max({largest, (motion.start[k] - motion.start[0]).norm(), (motion.end[k] - motion.end[0]).norm()});
  return largest;
}

PairMotion scaled(PairMotion motion, double scale) {
  for (std::size_t k = 0; k < 4; ++k) {
    motion.start[k] *= scale;
    motion.end[k] *= scale;
  }
  return motion;
}

/// Never late, and a report means that the pair really comes within 1.1 of the separation.
void check_against_reference(EventKind kind, const PairMotion& motion, double separation, std::vector<double>& early) {
  const double found = time_of_impact(kind, motion, separation);
  const reference::Answer truth = reference::first_time(kind, motion, separation, 1e-7L);
  CHECK(static_cast<long double>(found) <= truth.time);
  if (found == never) return;
  const double rounding = 1e-12 * extent(motion);
  const reference::Answer wide = reference::first_time(kind, motion, 1.1L * separation + rounding, 1e-7L);
  CHECK(wide.least <= 1.1 * separation + 1e-6 * extent(motion));
  if (std::isfinite(static_cast<double>(truth.time))) early.push_back(static_cast<double>(truth.time) - found);
}

}  // namespace

TEST_CASE("narrow phase: never late, and tight, against a search by bisection") {
  MotionMaker make(7);
  for (int sort = 0; sort < MotionMaker::sort_count; ++sort) {
    CAPTURE(sort);
    std::vector<double> early;
    for (int trial = 0; trial < 300; ++trial)
      for (const EventKind kind : both_kinds) {
        const PairMotion motion = make.make(sort);
        check_against_reference(kind, motion, 0.05 * make.number(0, 1), early);
      }
    REQUIRE(early.size() > 20);
    std::nth_element(early.begin(), early.begin() + static_cast<std::ptrdiff_t>(early.size() / 2), early.end());
    CHECK(early[early.size() / 2] < 1e-3);
  }
}

TEST_CASE("narrow phase: a head-on vertex meets the face when the gap is used up") {
  PairMotion motion;
  motion.start = {Vector3(0.25, 0.25, 1), Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(0, 1, 0)};
  motion.end = motion.start;
  motion.end[0][2] = -1;
  CHECK(time_of_impact(EventKind::vertex_face, motion, 0) == doctest::Approx(0.5).epsilon(1e-12));
  CHECK(time_of_impact(EventKind::vertex_face, motion, 0.2) == doctest::Approx(0.4).epsilon(1e-3));
  const auto contact = first_contact(EventKind::vertex_face, motion, {0, 0.5});
  REQUIRE(contact);
  CHECK(contact->normal.isApprox(Vector3::UnitZ()));
  CHECK(contact->start_distance == 1);
  CHECK(contact->weights == std::array<double, 4>{1, -0.5, -0.25, -0.25});
}

TEST_CASE("narrow phase: the distance at the reference determines the clearance of a pair") {
  PairMotion motion;
  motion.start = {Vector3(0.25, 0.25, 1), Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(0, 1, 0)};
  motion.end = motion.start;
  motion.end[0][2] = 0;
  const auto from = [&](double start, double reference) {
    motion.start[0][2] = start;
    motion.reference = motion.start;
    (*motion.reference)[0][2] = reference;
    return first_contact(EventKind::vertex_face, motion, {0.4, 0.5});
  };
  CHECK(from(1, 0.8)->time == doctest::Approx(0.6).epsilon(1e-3));  // it keeps 0.4
  CHECK(from(1, 0.8)->clearance.threshold == 0.4);
  CHECK(from(1, 0.2)->time == doctest::Approx(0.9).epsilon(1e-3));  // half of 0.2, although it starts further away
  CHECK(from(1, 0.2)->clearance.threshold == doctest::Approx(0.1));
  CHECK(from(0.15, 0.2)->time == doctest::Approx(1 / 3.0).epsilon(1e-2));
  CHECK(from(0.1, 0.2)->time == 0);   // as near as it may
  CHECK(from(0.05, 0.2)->time == 0);  // nearer: it may not come nearer
  motion.end[0][2] = 0.1;
  CHECK_FALSE(from(0.05, 0.2));  // but may part
  motion.end[0][2] = 0.11;
  CHECK_FALSE(from(1, 0.2));
}

TEST_CASE("narrow phase: the result does not depend on the scale") {
  MotionMaker make(3);
  for (int trial = 0; trial < 50; ++trial)
    for (const EventKind kind : both_kinds) {
      const PairMotion motion = make.make(MotionMaker::general);
      const double time = time_of_impact(kind, motion, 0.03);
      for (const int exponent : {-24, 24})
        CHECK(time_of_impact(kind, scaled(motion, std::ldexp(1, exponent)), std::ldexp(0.03, exponent)) == time);
      for (const double scale : {1e-7, 1e7}) {
        const double other = time_of_impact(kind, scaled(motion, scale), 0.03 * scale);
        if (time == never)
          CHECK(other == never);
        else
          CHECK(other == doctest::Approx(time).epsilon(1e-3));
      }
    }
}

TEST_CASE("narrow phase: common motion is not a contact") {
  MotionMaker make(5);
  for (int trial = 0; trial < 200; ++trial)
    for (const EventKind kind : both_kinds) {
      PairMotion motion = make.make(MotionMaker::grid);
      const Vector3 shift(make.number(-9, 9), make.number(-9, 9), make.number(-9, 9));
      for (std::size_t k = 0; k < 4; ++k) motion.end[k] = motion.start[k] + Vector3(shift.cast<float>().cast<double>());
      CHECK_FALSE(first_contact(kind, motion, {0.5, 0.5}));
      CHECK_FALSE(first_contact(kind, motion, {0, 0.5}));
    }
}

TEST_CASE("narrow phase: touching at the start counts only if the sides approach") {
  PairMotion motion;
  motion.start = {Vector3(0.25, 0.25, 0), Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(0, 1, 0)};
  const auto moved_by = [&](const Vector3& shift) {
    motion.end = motion.start;
    motion.end[0] += shift;
    return first_contact(EventKind::vertex_face, motion, {0.01, 0.5});
  };
  CHECK_FALSE(moved_by({0, 0, 1}));
  CHECK_FALSE(moved_by({0.1, 0.1, 0}));
  motion.start = {Vector3(-1, 0, 0), Vector3(1, 0, 0), Vector3(0, 0, 0), Vector3(0, 0, 1)};
  motion.end = {Vector3(-1, -1, 0), Vector3(1, -1, 0), Vector3(0, 1, 0), Vector3(0, 0, 1)};
  CHECK(time_of_impact(EventKind::edge_edge, motion, 0) == 0);
}

TEST_CASE("narrow phase: contacts after the latest time are left out, others stay the same") {
  MotionMaker make(11);
  for (int trial = 0; trial < 300; ++trial) {
    const PairMotion motion = make.make(MotionMaker::general);
    const auto contact = first_contact(EventKind::edge_edge, motion, {0.02, 0.5});
    const double latest = make.number(0, 1);
    const auto cut = first_contact(EventKind::edge_edge, motion, {0.02, 0.5}, latest);
    if (contact && contact->time <= latest)
      CHECK((cut && cut->time == contact->time && cut->weights == contact->weights));
    else
      CHECK_FALSE(cut);
  }
}

TEST_CASE("narrow phase: the normal points from the second to the first side, against the approach") {
  MotionMaker make(13);
  int seen = 0;
  for (int trial = 0; trial < 400; ++trial)
    for (const EventKind kind : both_kinds) {
      const PairMotion motion = make.make(MotionMaker::general);
      const auto contact = first_contact(kind, motion, {0.02, 0.5});
      if (!contact || contact->time == 0) continue;
      Vector3 separation = Vector3::Zero(), relative = Vector3::Zero();
      for (std::size_t k = 0; k < 4; ++k) {
        const Vector3 step = motion.end[k] - motion.start[k];
        separation += contact->weights[k] * (motion.start[k] + contact->time * step);
        relative += contact->weights[k] * step;
      }
      CHECK(contact->normal.norm() == doctest::Approx(1));
      CHECK(contact->normal.dot(separation.normalized()) == doctest::Approx(1));
      CHECK(contact->normal.dot(relative) <= 0);
      ++seen;
    }
  CHECK(seen > 100);
}

// From an edit in which two sheets slide over each other. It was reported at 0.1 and 0.2 without a direction, which
// ended the edit: the planes turned too far at once, and the steps ran out.
TEST_CASE("narrow phase: a triangle that turns by much just beside a vertex is followed all the way") {
  const double separation = 0.000143614;
  PairMotion apart;  // never nearer than 1.96 separations
  apart.start = {Vector3(-0.21690352261066437, -0.097364254295825958, -0.64985150098800659),
                 Vector3(-0.19409334659576416, -0.17285816371440887, -0.65644043684005737),
                 Vector3(-0.21808119118213654, -0.092100881040096283, -0.65052640438079834),
                 Vector3(-0.41900405287742615, -0.13450151681900024, -0.35686787962913513)};
  apart.end = {Vector3(-0.22554981708526611, -0.09608728438615799, -0.68416470289230347),
               Vector3(-0.19391599297523499, -0.15732350945472717, -0.72345006465911865),
               Vector3(-0.22656919062137604, -0.094815649092197418, -0.68525660037994385),
               Vector3(-0.24565017223358154, -0.17206443846225739, -0.0026472785975784063)};
  CHECK_FALSE(first_contact(EventKind::vertex_face, apart, {separation, 0.5}));
  PairMotion meeting;
  meeting.start = {Vector3(-0.13622933626174927, -0.30704113841056824, -0.69579845666885376),
                   Vector3(-0.15452510118484497, -0.30461135506629944, -0.72061413526535034),
                   Vector3(0.0051484480500221252, -0.41898763179779053, -0.36020433902740479),
                   Vector3(-0.068986393511295319, -0.25256946682929993, -0.7075003981590271)};
  meeting.end = {Vector3(-0.12597635388374329, -0.28308513760566711, -0.72242450714111328),
                 Vector3(-0.14812690019607544, -0.29980728030204773, -0.75939053297042847),
                 Vector3(-0.064732268452644348, -0.33793842792510986, -0.022614952176809311),
                 Vector3(-0.10579831898212433, -0.23464904725551605, -0.81079947948455811)};
  const double half = witness(EventKind::vertex_face, meeting.start).distance / 2;
  const auto contact = first_contact(EventKind::vertex_face, meeting, {half, 0.5});
  REQUIRE(contact);
  CHECK(contact->time > 0.601);  // by 100,000 samples of the distance, it is first below half at 0.60204
  CHECK(contact->time < 0.60204);
  CHECK(contact->normal.norm() == doctest::Approx(1));
}
