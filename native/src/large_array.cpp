// SPDX-License-Identifier: GPL-3.0-or-later
#include "large_array.hpp"

#include <algorithm>
#include <bit>
#include <map>
#include <mutex>

namespace stiv {

namespace {

constexpr std::size_t alignment = 64;
constexpr std::size_t least_kept = 1 << 15;              // bytes of a block
constexpr std::size_t most_kept = std::size_t{3} << 27;  // of all blocks

/// Before the memory of each array.
struct alignas(alignment) Header {
  std::size_t size;  ///< with the header
};

/// Rounded up by at most an eighth, so that arrays of similar sizes use the same memory.
std::size_t rounded(std::size_t size) {
  if (size < least_kept) return size;
  const std::size_t step = std::bit_floor(size) / 8;
  return (size + step - 1) / step * step;
}

/// Freed blocks by size.
class KeptBlocks {
 public:
  static KeptBlocks& all() {
    static KeptBlocks& blocks = *new KeptBlocks;  // never destroyed: static objects may free arrays later
    return blocks;
  }

  void begin() {
    const std::lock_guard lock(mutex_);
    ++users_;
  }

  void end() {
    std::multimap<std::size_t, void*> unused;
    {
      const std::lock_guard lock(mutex_);
      if (--users_ > 0) return;
      bytes_ = 0;
      unused.swap(blocks_);
    }
    for (const auto& [size, block] : unused) release(block);
  }

  std::size_t bytes() {
    const std::lock_guard lock(mutex_);
    return bytes_;
  }

  /// The smallest block that fits, unless most of it would remain unused; null if there is none.
  void* take(std::size_t size) {
    const std::lock_guard lock(mutex_);
    const auto found = blocks_.lower_bound(size);
    if (found == blocks_.end() || found->first > 2 * size) return nullptr;
    void* const block = found->second;
    bytes_ -= found->first;
    blocks_.erase(found);
    return block;
  }

  /// Returns whether the block is kept.
  bool keep(void* block, std::size_t size) noexcept {
    try {
      const std::lock_guard lock(mutex_);
      if (users_ == 0 || bytes_ + size > most_kept) return false;
      blocks_.emplace(size, block);
      bytes_ += size;
      return true;
    } catch (const std::exception&) {
      return false;  // no memory for the entry
    }
  }

  static void release(void* block) noexcept { ::operator delete (block, std::align_val_t{alignment}); }

 private:
  std::mutex mutex_;
  std::multimap<std::size_t, void*> blocks_;
  std::size_t bytes_ = 0;
  int users_ = 0;
};

}  // namespace

MemoryReuse::MemoryReuse() { KeptBlocks::all().begin(); }
MemoryReuse::~MemoryReuse() { KeptBlocks::all().end(); }
std::size_t MemoryReuse::kept_bytes() { return KeptBlocks::all().bytes(); }

void* allocate_large(std::size_t bytes) {
  const std::size_t size = rounded(bytes + sizeof(Header));
  void* block = size < least_kept ? nullptr : KeptBlocks::all().take(size);
  if (block == nullptr) block = new (::operator new (size, std::align_val_t{alignment})) Header{size};
  return static_cast<Header*>(block) + 1;
}

void free_large(void* memory) noexcept {
  Header* const header = static_cast<Header*>(memory) - 1;
  const std::size_t size = header->size;
  if (size < least_kept || !KeptBlocks::all().keep(header, size)) KeptBlocks::release(header);
}

}  // namespace stiv
