// SPDX-License-Identifier: GPL-3.0-or-later
#include "editing/effective_separation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "stiv/error.hpp"

namespace stiv {

namespace {

constexpr double automatic_fraction = 1e-4;  // of the diagonal; see experiments.md, "Volumes"
constexpr double least_units = 4;            // units in the last place
constexpr double double_noise = 1e-14;       // error of the distance computations, relative to coordinates

/// Distance from |x| to the next larger number in single precision.
double unit_in_last_place(double x) {
  const auto value = static_cast<float>(std::abs(x));
  return static_cast<double>(std::nextafter(value, std::numeric_limits<float>::infinity())) -
         static_cast<double>(value);
}

/// World size of a unit in the last place of controls stored in a frame.
double unit_in_frame(const StorageFrame& storage, const Controls& p, const std::vector<Index>& rows_without_length) {
  const Eigen::Affine3d to_local(storage.frame.inverse());
  double largest = 0;
  for (Index row = storage.first; row < storage.first + storage.count; ++row) {
    if (std::binary_search(rows_without_length.begin(), rows_without_length.end(), row)) continue;
    const Vector3 local = to_local * Vector3(p.row(row));
    largest = std::max(largest, local.cwiseAbs().maxCoeff());
  }
  return unit_in_last_place(largest) * storage.frame.topLeftCorner<3, 3>().colwise().norm().maxCoeff();
}

std::vector<unsigned char> movable_vertices(const Surface& surface, const Deformation& deformation) {
  std::vector<unsigned char> movable(surface.vertex_count(), 0);
  for (Index control = 0; control < deformation.control_count(); ++control)
    for (const Index vertex : deformation.support(control)) movable[vertex] = !surface.is_fixed(vertex);
  if (std::find(movable.begin(), movable.end(), 1) == movable.end()) std::fill(movable.begin(), movable.end(), 1);
  return movable;
}

void check_can_be_kept(double separation, const MovingExtent& extent, double least) {
  if (std::isfinite(separation) && separation >= least) return;
  std::ostringstream message;
  message.precision(3);
  message << "separation " << separation << ": the least that can be kept here is " << least
          << ", because coordinates reach " << extent.largest_coordinate
          << " and are stored in single precision; use at least that, 0 for automatic, or move the scene nearer to the "
             "origin";
  throw InputError(message.str());
}

}  // namespace

MovingExtent moving_extent(const Surface& surface, const Deformation& deformation, const Positions& q) {
  const std::vector<unsigned char> movable = movable_vertices(surface, deformation);
  Eigen::AlignedBox3d box;
  MovingExtent extent;
  for (Index vertex = 0; vertex < q.rows(); ++vertex) {
    if (!movable[vertex]) continue;
    box.extend(Vector3(q.row(vertex)));
    extent.largest_coordinate = std::max(extent.largest_coordinate, q.row(vertex).cwiseAbs().maxCoeff());
  }
  extent.diagonal = box.isEmpty() ? 0 : box.diagonal().norm();
  return extent;
}

double least_separation(const MovingExtent& extent, const Controls& p, const std::vector<StorageFrame>& frames,
                        const std::vector<Index>& rows_without_length) {
  if (frames.empty()) return double_noise * extent.largest_coordinate;
  double unit = unit_in_last_place(extent.largest_coordinate);
  for (const StorageFrame& storage : frames) unit = std::max(unit, unit_in_frame(storage, p, rows_without_length));
  return least_units * unit;
}

double effective_separation(double asked, const MovingExtent& extent, double least) {
  if (asked == 0) return std::max(automatic_fraction * extent.diagonal, least);
  check_can_be_kept(asked, extent, least);
  return asked;
}

void check_body(Index body, std::size_t bodies) {
  if (body < 0 || at(body) >= bodies)
    throw InputError("pair_separations: there is no body " + std::to_string(body) + ", only 0.." +
                     std::to_string(bodies - 1));
}

BodySeparations body_separations(const Surface& surface, const std::vector<BodyPairSeparation>& asked,
                                 double separation, const MovingExtent& extent, double least) {
  BodySeparations separations(surface.bodies().size(), separation);
  for (const BodyPairSeparation& pair : asked) {
    for (const Index body : {pair.first, pair.second}) check_body(body, surface.bodies().size());
    check_can_be_kept(pair.separation, extent, least);
    separations.set(pair.first, pair.second, pair.separation);
  }
  return separations;
}

}  // namespace stiv
