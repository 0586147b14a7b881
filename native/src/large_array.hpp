// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <new>
#include <utility>
#include <vector>

namespace stiv {

/// While one exists, freed memory of large arrays is kept for later ones, up to a limit. The system clears new pages,
/// which takes as long as most work on them. The last one that ends frees the memory.
class MemoryReuse {
 public:
  MemoryReuse();
  ~MemoryReuse();
  MemoryReuse(const MemoryReuse&) = delete;
  MemoryReuse& operator=(const MemoryReuse&) = delete;

  /// Bytes that are kept now.
  static std::size_t kept_bytes();
};

/// Aligned to 64 bytes.
void* allocate_large(std::size_t bytes);
void free_large(void* memory) noexcept;

template <class Item>
struct LargeAllocator {
  static_assert(alignof(Item) <= 64);
  using value_type = Item;

  LargeAllocator() = default;
  template <class Other>
  LargeAllocator(const LargeAllocator<Other>&) noexcept {}  // NOLINT(google-explicit-constructor): as standard ones do

  Item* allocate(std::size_t count) {
    if (count > static_cast<std::size_t>(-1) / 2 / sizeof(Item)) throw std::bad_array_new_length();
    return static_cast<Item*>(allocate_large(count * sizeof(Item)));
  }
  void deallocate(Item* items, std::size_t /*count*/) noexcept { free_large(items); }

  /// Items without a value stay uninitialized: to clear them would write the memory twice.
  template <class Other>
  void construct(Other* item) noexcept {
    ::new (static_cast<void*>(item)) Other;
  }
  template <class Other, class... Arguments>
  void construct(Other* item, Arguments&&... arguments) {
    ::new (static_cast<void*>(item)) Other(std::forward<Arguments>(arguments)...);
  }

  friend bool operator==(const LargeAllocator&, const LargeAllocator&) = default;
};

/// A vector that may become large, with memory that MemoryReuse keeps. Items that are added without a value are
/// uninitialized.
template <class Item>
using LargeArray = std::vector<Item, LargeAllocator<Item>>;

}  // namespace stiv
