// SPDX-License-Identifier: GPL-3.0-or-later

// No "#pragma once": Highway's header is included once for each target, and has its own guards.
#include "hwy/highway.h"

#ifndef STIV_VECTOR_DISPATCH_HPP
#define STIV_VECTOR_DISPATCH_HPP

#include "stiv/vector_target.hpp"

#if HWY_TARGETS & HWY_AVX2
#define STIV_FOR_AVX2(function) &N_AVX2::function
#else
#define STIV_FOR_AVX2(function) &HWY_STATIC_DISPATCH(function)
#endif
#if HWY_TARGETS & HWY_AVX3
#define STIV_FOR_AVX512(function) &N_AVX3::function
#else
#define STIV_FOR_AVX512(function) STIV_FOR_AVX2(function)
#endif

/// The version of `function` (in the same namespace as the caller) for the target in use.
#define STIV_FOR_VECTOR_TARGET(function) \
  ::stiv::choose_by_vector_target(&HWY_STATIC_DISPATCH(function), STIV_FOR_AVX2(function), STIV_FOR_AVX512(function))

namespace stiv {

template <class Function>
Function* choose_by_vector_target(Function* baseline, Function* avx2, Function* avx512) {
  switch (vector_target()) {
    case VectorTarget::avx512:
      return avx512;
    case VectorTarget::avx2:
      return avx2;
    default:
      return baseline;
  }
}

}  // namespace stiv

#endif
