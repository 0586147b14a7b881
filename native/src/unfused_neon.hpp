// SPDX-License-Identifier: GPL-3.0-or-later
// Eigen on arm64 with the bits of x86-64: multiplication and addition each round once, and matrix products sum in the
// same order. Included before each source, and by Eigen itself (EIGEN_DENSEBASE_PLUGIN) after its definitions for NEON.

#ifdef EIGEN_DENSEBASE_H
#undef EIGEN_HAS_SINGLE_INSTRUCTION_MADD  // blocks of another height, whose last rows are summed in another order
#else
#include <arm_neon.h>

#undef vfmaq_f64
#undef vfmaq_n_f64
#undef vfmaq_laneq_f64
#define vfmaq_f64(sum, a, b) vaddq_f64(sum, vmulq_f64(a, b))
#define vfmaq_n_f64(sum, a, b) vaddq_f64(sum, vmulq_n_f64(a, b))
#define vfmaq_laneq_f64(sum, a, b, lane) vaddq_f64(sum, vmulq_laneq_f64(a, b, lane))
#endif
