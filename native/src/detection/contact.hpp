// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "detection/conservative_advancement.hpp"

namespace stiv {

/// What is told of a contact that a narrow phase found.
Contact contact_of(const RelativeMotion<double>& motion, const Approach<double>& approach, double start_distance);

}  // namespace stiv
