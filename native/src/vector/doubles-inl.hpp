// SPDX-License-Identifier: GPL-3.0-or-later

// Vectors of doubles. Included once for each target; see vector/foreach_target.hpp.
#if defined(STIV_VECTOR_DOUBLES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef STIV_VECTOR_DOUBLES_INL
#undef STIV_VECTOR_DOUBLES_INL
#else
#define STIV_VECTOR_DOUBLES_INL
#endif

#include "vector/dispatch.hpp"

HWY_BEFORE_NAMESPACE();
namespace stiv::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Doubles = hn::CappedTag<double, 8>;
using Lanes = hn::Vec<Doubles>;  ///< a double in each lane
using Mask = hn::Mask<Doubles>;  ///< true or false in each lane

}  // namespace stiv::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
