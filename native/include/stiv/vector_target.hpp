// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace stiv {

/// Vector instructions that parts of the core are compiled for; chosen at run time. All give the same bits, since they
/// use IEEE 754 operations lane by lane, none fused or approximate.
enum class VectorTarget {
  baseline,  ///< on every processor of the architecture (x86-64: SSE2 or scalar code; arm64: NEON)
  avx2,      ///< x86-64 with AVX2
  avx512     ///< x86-64 with AVX-512 F, VL, DQ, BW and CD
};

/// The best target of this processor and this build.
VectorTarget best_vector_target();

/// The target in use: the best one up to the limit.
VectorTarget vector_target();

/// Limits the target for the whole process. For tests and benchmarks.
void limit_vector_target(VectorTarget most);

}  // namespace stiv
