// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace stiv {

/// How many threads a call takes that is told no number: one for each processor that this process may run on, no more
/// than the environment's STIV_THREADS if that is set, as it is for processes that share a machine (a batch's workers).
/// @throws InputError if STIV_THREADS is not a whole number from 1 up
int usable_processors();

}  // namespace stiv
