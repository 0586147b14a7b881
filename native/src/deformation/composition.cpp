// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/deformation/composition.hpp"

#include <string>

#include "deformation/weight_rows.hpp"
#include "stiv/error.hpp"

namespace stiv {

namespace {

using Entry = WeightMatrix::InnerIterator;

WeightMatrix product(const WeightMatrix& outer, const WeightMatrix& inner) {
  WeightRows rows(static_cast<Index>(outer.rows()), static_cast<Index>(inner.cols()));
  for (Index row = 0; row < outer.rows(); ++row) {
    for (Entry a(outer, row); a; ++a)
      for (Entry b(inner, a.col()); b; ++b) rows.add(static_cast<Index>(b.col()), a.value() * b.value());
    rows.end_row();
  }
  return rows.matrix();
}

}  // namespace

std::shared_ptr<const LinearDeformation> make_composition(const LinearDeformation& outer,
                                                          const LinearDeformation& inner) {
  if (outer.control_count() != inner.vertex_count())
    throw InputError("composition: the outer deformation has " + std::to_string(outer.control_count()) +
                     " controls, the inner one moves " + std::to_string(inner.vertex_count()) +
                     " vertices; they must be the same");
  const bool shifted = inner.offset().rows() > 0 || outer.offset().rows() > 0;
  const Controls origin = Controls::Zero(inner.control_count(), 3);
  return make_linear(product(outer.weights(), inner.weights()),
                     shifted ? outer.surface(inner.surface(origin)) : Positions());
}

}  // namespace stiv
