// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/vector_target.hpp"

#include <algorithm>
#include <atomic>

namespace stiv {

namespace {

std::atomic<VectorTarget> limit{VectorTarget::avx512};

}  // namespace

VectorTarget best_vector_target() {
#if defined(__x86_64__)
  // The compiler's own detection, which also asks whether the operating system saves the registers.
  static const VectorTarget best = [] {
    __builtin_cpu_init();  // on Windows no constructor does it
    if (!__builtin_cpu_supports("avx2")) return VectorTarget::baseline;
    const bool avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
                        __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
                        __builtin_cpu_supports("avx512cd");
    return avx512 ? VectorTarget::avx512 : VectorTarget::avx2;
  }();
  return best;
#else
  return VectorTarget::baseline;
#endif
}

VectorTarget vector_target() { return std::min(best_vector_target(), limit.load(std::memory_order_relaxed)); }

void limit_vector_target(VectorTarget most) { limit.store(most, std::memory_order_relaxed); }

}  // namespace stiv
