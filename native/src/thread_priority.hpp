// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace stiv {

/// Lets other threads of the process come first from now on. Without effect where the system does not allow it.
void lower_thread_priority() noexcept;

}  // namespace stiv
