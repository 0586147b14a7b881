// SPDX-License-Identifier: GPL-3.0-or-later
#include "penetration/penetration.hpp"

#include <algorithm>
#include <cmath>

#include "penetration/winding_numbers.hpp"

namespace stiv {

namespace {

/// Adds the contribution of a side to the volume and to its uncertainty.
void add_side(const Crossings& crossings, std::size_t side, double rounding, Penetration& sum) {
  const PlacedBody& body = crossings.body(side);
  const Vector3 origin = crossings.body(0).point(0);
  const std::vector<double> means = mean_windings(crossings, side);
  for (Index k = 0; k < body.triangle_count(); ++k) {
    const double mean = means[at(k)];
    if (mean == 0) continue;
    const Vector3 area = body.area_vector(k);
    sum.amount += mean * area.dot(body.point(body.corners(k)[0]) - origin) / 6;
    sum.uncertainty += rounding * std::abs(mean) * area.norm() / 2;
  }
}

Vector3 point_at(const Triangle& t, const Eigen::Vector2d& weights) {
  return t[0] + weights[0] * (t[1] - t[0]) + weights[1] * (t[2] - t[0]);
}

Vector3 direction_of(const Crossings& crossings, const Cut& cut) {
  const Triangle triangle = crossings.body(0).triangle(cut.triangles[0]);
  return point_at(triangle, cut.ends[0][1]) - point_at(triangle, cut.ends[0][0]);
}

/// The sine of the angle between the triangles of a cut.
double sine_between(const Crossings& crossings, const Cut& cut) {
  const Vector3 first = crossings.body(0).area_vector(cut.triangles[0]),
                second = crossings.body(1).area_vector(cut.triangles[1]);
  const double product = first.norm() * second.norm();
  return product > 0 ? first.cross(second).norm() / product : 0;
}

/// The fraction of the first triangle that its cut sweeps if the second moves by `rounding`. It grows as the angle
/// between the triangles decreases.
double swept_fraction(const Crossings& crossings, const Cut& cut, double rounding) {
  const double length = direction_of(crossings, cut).norm();
  const Vector3 area = crossings.body(0).area_vector(cut.triangles[0]),
                other = crossings.body(1).area_vector(cut.triangles[1]);
  const double passed = 2 * rounding * length * other.norm(), whole = area.cross(other).norm();
  return passed < whole ? passed / whole : 1;
}

Penetration perturbed_area_inside(const Crossings& crossings, const std::vector<double>& areas, double rounding) {
  Penetration sum;
  const std::vector<double> means = mean_windings(crossings, 0);
  for (std::size_t k = 0; k < areas.size(); ++k) sum.amount += areas[k] * means[k];
  std::vector<double> passed(areas.size(), 0);
  for (const Cut& cut : crossings.cuts()) passed[at(cut.triangles[0])] += swept_fraction(crossings, cut, rounding);
  for (std::size_t k = 0; k < areas.size(); ++k) sum.uncertainty += areas[k] * std::min(passed[k], 1.0);
  return sum;
}

}  // namespace

Penetration common_volume(const PlacedBody& a, const PlacedBody& b, const IndexPairs& candidates, double rounding) {
  const Crossings crossings(a, b, candidates, 1);  // a volume does not depend on the perturbation
  Penetration sum;
  add_side(crossings, 0, rounding, sum);
  add_side(crossings, 1, rounding, sum);
  return sum;
}

Penetration area_inside(const PlacedBody& open, const std::vector<double>& start_areas, const PlacedBody& closed,
                        const IndexPairs& candidates, double rounding) {
  const Crossings one_way(open, closed, candidates, 1);
  const Penetration first = perturbed_area_inside(one_way, start_areas, rounding);
  if (!one_way.touching()) return first;
  const Penetration second = perturbed_area_inside(Crossings(open, closed, candidates, -1), start_areas, rounding);
  return {(first.amount + second.amount) / 2, (first.uncertainty + second.uncertainty) / 2};
}

// An end of a cut moves by at most the rounding of both triangles, divided by the sine of their angle.
Penetration intersection_length(const PlacedBody& a, const PlacedBody& b, const IndexPairs& candidates,
                                double rounding) {
  const Crossings crossings(a, b, candidates, 1);
  Penetration sum;
  for (const Cut& cut : crossings.cuts()) {
    const double length = direction_of(crossings, cut).norm(), sine = sine_between(crossings, cut);
    sum.amount += length;
    sum.uncertainty += 4 * rounding < length * sine ? 4 * rounding / sine : length;
  }
  return sum;
}

}  // namespace stiv
