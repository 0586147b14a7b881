// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace stiv {

/// Vector instructions that parts of the core are compiled for; which are used is decided when they run. All of them
/// give the same bits: no operation but those of IEEE 754, lane by lane, none fused, none approximate.
enum class VectorTarget {
  baseline,  ///< what every processor of the architecture has (x86-64: SSE2 or scalar code; arm64: NEON)
  avx2,      ///< x86-64 with AVX2
  avx512     ///< x86-64 with AVX-512 F, VL, DQ, BW and CD
};

/// The most that this processor and this build have.
VectorTarget best_vector_target();

/// What is in use: the best, or the limit if that is less.
VectorTarget vector_target();

/// Use nothing above `most` from now on, in the whole process. For tests and benchmarks.
void limit_vector_target(VectorTarget most);

}  // namespace stiv
