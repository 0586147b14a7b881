// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/vector_target.hpp"

#include <algorithm>
#include <atomic>

#if defined(__x86_64__)
#include <cpuid.h>
#endif

namespace stiv {

namespace {

std::atomic<VectorTarget> limit{VectorTarget::avx512};

#if defined(__x86_64__)

/// Does the operating system save these registers? A bit for each kind. [Intel 64 manual, volume 1, section 13.3]
bool saves(unsigned kinds) {
  unsigned saved = 0, high = 0;
  __asm__("xgetbv" : "=a"(saved), "=d"(high) : "c"(0));
  return (saved & kinds) == kinds;
}

/// Asks the processor. The __builtin_cpu_supports of Zig's library always says no.
VectorTarget detected() {
  constexpr unsigned avx_registers = 0x06, avx512_registers = 0xe6;
  constexpr unsigned avx512 = bit_AVX512F | bit_AVX512DQ | bit_AVX512CD | bit_AVX512BW | bit_AVX512VL;
  unsigned a = 0, b = 0, c = 0, d = 0;
  if (__get_cpuid(1, &a, &b, &c, &d) == 0 || (c & bit_OSXSAVE) == 0 || !saves(avx_registers))
    return VectorTarget::baseline;
  if (__get_cpuid_count(7, 0, &a, &b, &c, &d) == 0 || (b & bit_AVX2) == 0) return VectorTarget::baseline;
  return (b & avx512) == avx512 && saves(avx512_registers) ? VectorTarget::avx512 : VectorTarget::avx2;
}

#else

VectorTarget detected() { return VectorTarget::baseline; }

#endif

}  // namespace

VectorTarget best_vector_target() {
  static const VectorTarget best = detected();
  return best;
}

VectorTarget vector_target() { return std::min(best_vector_target(), limit.load(std::memory_order_relaxed)); }

void limit_vector_target(VectorTarget most) { limit.store(most, std::memory_order_relaxed); }

}  // namespace stiv
