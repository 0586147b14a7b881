// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Compiles the including file once for each of the targets of stiv/vector_target.hpp, with Highway's headers; its
// library is not linked. A file with vector code looks like this:
//
//   #undef HWY_TARGET_INCLUDE
//   #define HWY_TARGET_INCLUDE "folder/this_file.cpp"
//   #include "vector/foreach_target.hpp"  // this file again, for each target
//   #include "vector/dispatch.hpp"
//   HWY_BEFORE_NAMESPACE();               // from here on, the target's instructions
//   namespace stiv::HWY_NAMESPACE { void work(...) { ... } }
//   HWY_AFTER_NAMESPACE();
//   #if HWY_ONCE
//   namespace stiv { void work(...) { STIV_FOR_VECTOR_TARGET(work)(...); } }
//   #endif
//
// Between BEFORE and AFTER include nothing: the linker keeps one copy of an inline function, which must not be one with
// instructions that another processor lacks. Lambdas there are not compiled for the target by every compiler.

// Targets between those that are listed there, above them (lower bits), and those with vectors of a length unknown at
// compile time.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | (HWY_AVX3 - 1) | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
// Instructions that are not used need not be available; fused operations must not be used.
#define HWY_DISABLE_PCLMUL_AES
#define HWY_DISABLE_BMI2_FMA
#define HWY_DISABLE_F16C
// On arm64 only NEON is used, which is always available. Choosing it at run time would add instructions that some
// processors lack (AES), and GCC does not let a struct of vectors have a constructor then.
#if defined(__aarch64__) && !defined(TOOLCHAIN_MISS_SYS_AUXV_H)
#define TOOLCHAIN_MISS_SYS_AUXV_H
#endif
// Assertions of Highway would need its library.
#define HWY_IS_DEBUG_BUILD 0

#include "hwy/foreach_target.h"
