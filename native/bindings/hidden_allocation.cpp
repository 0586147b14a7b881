// SPDX-License-Identifier: GPL-3.0-or-later
// For macOS modules that contain the C++ library: its operators new and delete are weak and visible, and the loader
// would merge them with those of Blender. These are hidden by -fvisibility-global-new-delete=force-hidden.
#include <algorithm>
#include <cstdlib>
#include <new>

namespace {

void* allocated(std::size_t size) noexcept { return std::malloc(std::max<std::size_t>(size, 1)); }

void* allocated(std::size_t size, std::align_val_t alignment) noexcept {
  void* memory = nullptr;
  const std::size_t bytes = std::max(static_cast<std::size_t>(alignment), sizeof(void*));
  return posix_memalign(&memory, bytes, std::max<std::size_t>(size, 1)) == 0 ? memory : nullptr;
}

void* checked(void* memory) {
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace

using Alignment = std::align_val_t;
using Quiet = const std::nothrow_t&;

void* operator new(std::size_t n) { return checked(allocated(n)); }
void* operator new[](std::size_t n) { return checked(allocated(n)); }
void* operator new(std::size_t n, Quiet) noexcept { return allocated(n); }
void* operator new[](std::size_t n, Quiet) noexcept { return allocated(n); }
void* operator new(std::size_t n, Alignment a) { return checked(allocated(n, a)); }
void* operator new[](std::size_t n, Alignment a) { return checked(allocated(n, a)); }
void* operator new(std::size_t n, Alignment a, Quiet) noexcept { return allocated(n, a); }
void* operator new[](std::size_t n, Alignment a, Quiet) noexcept { return allocated(n, a); }

void operator delete(void* p) noexcept { std::free(p); }
void operator delete[](void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
void operator delete[](void* p, std::size_t) noexcept { std::free(p); }
void operator delete(void* p, Quiet) noexcept { std::free(p); }
void operator delete[](void* p, Quiet) noexcept { std::free(p); }
void operator delete(void* p, Alignment) noexcept { std::free(p); }
void operator delete[](void* p, Alignment) noexcept { std::free(p); }
void operator delete(void* p, std::size_t, Alignment) noexcept { std::free(p); }
void operator delete[](void* p, std::size_t, Alignment) noexcept { std::free(p); }
void operator delete(void* p, Alignment, Quiet) noexcept { std::free(p); }
void operator delete[](void* p, Alignment, Quiet) noexcept { std::free(p); }
