// SPDX-License-Identifier: GPL-3.0-or-later
// Included before each source of OpenSubdiv, whose std::sin and std::cos become ours: weights of extraordinary vertices
// have the same bits on every platform. The names are replaced after all standard headers that declare them.
#pragma once

#define _USE_MATH_DEFINES  // M_PI on Windows
#include <cmath>
#include <complex>
#include <valarray>

#include "portable_math.hpp"

namespace stiv::opensubdiv_math {

inline double sine(double angle) { return portable_sin(angle); }
inline double cosine(double angle) { return portable_cos(angle); }
inline float sine(float angle) { return static_cast<float>(portable_sin(angle)); }
inline float cosine(float angle) { return static_cast<float>(portable_cos(angle)); }

}  // namespace stiv::opensubdiv_math

namespace std {
using stiv::opensubdiv_math::cosine;
using stiv::opensubdiv_math::sine;
}  // namespace std

#define sin sine
#define cos cosine
