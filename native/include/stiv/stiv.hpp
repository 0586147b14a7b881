// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// Everything that a program needs to edit, test and repair surfaces. docs/cpp_users.md lists the headers by topic.

#include "stiv/acceptance/deviation_test.hpp"
#include "stiv/acceptance/intersections.hpp"
#include "stiv/acceptance/least_distance.hpp"
#include "stiv/acceptance/step_check.hpp"
#include "stiv/deformation/combination.hpp"
#include "stiv/deformation/lattice.hpp"
#include "stiv/deformation/placement.hpp"
#include "stiv/deformation/scalars.hpp"
#include "stiv/deformation/subdivision.hpp"
#include "stiv/editing/session.hpp"
#include "stiv/error.hpp"
#include "stiv/job.hpp"
#include "stiv/repair/repair.hpp"
