// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace stiv {

/// Returns free pages of the C library's heap to the system, also those between blocks in use. Otherwise a process
/// keeps all pages of its largest demand so far. Only for glibc, where few free pages return by themselves. Blocks in
/// use stay as they are, so a host process may share the heap. Takes 0.3 ms for 9 MB of free pages.
void release_free_memory() noexcept;

}  // namespace stiv
