// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/metric/active_controls.hpp"

#include <cmath>

namespace stiv {

ActiveControls active_controls(const Eigen::VectorXd& squared_lengths, const Eigen::VectorXd& weights) {
  ActiveControls active;
  active.place.assign(static_cast<std::size_t>(weights.size()), -1);
  for (Index control = 0; control < weights.size(); ++control) {
    if (weights[control] == 0 || !(squared_lengths[control] > 0)) continue;
    active.place[at(control)] = static_cast<Index>(active.control.size());
    active.control.push_back(control);
    active.root_weight.push_back(std::sqrt(weights[control]));
  }
  return active;
}

ActiveVector restrict_to(const ActiveControls& active, const SparseField& g) {
  ActiveVector restricted;
  for (std::size_t k = 0; k < g.index.size(); ++k) {
    const Index place = active.place[at(g.index[k])];
    if (place < 0) continue;
    restricted.place.push_back(place);
    restricted.value.push_back(active.root_weight[at(place)] * g.value[k]);
  }
  return restricted;
}

ActiveColumns dense_columns(const ActiveControls& active, const ActiveVector& vector) {
  ActiveColumns dense = ActiveColumns::Zero(static_cast<Index>(active.control.size()), 3);
  for (std::size_t k = 0; k < vector.place.size(); ++k) dense.row(vector.place[k]) = vector.value[k].transpose();
  return dense;
}

SparseField extend_from(const ActiveControls& active, const ActiveColumns& values) {
  SparseField step;
  step.index = active.control;
  step.value.resize(active.control.size());
  for (std::size_t k = 0; k < step.value.size(); ++k)
    step.value[k] = active.root_weight[k] * values.row(static_cast<Index>(k)).transpose();
  return step;
}

}  // namespace stiv
