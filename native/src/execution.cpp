// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/execution.hpp"

#include <algorithm>
#include <cfenv>
#include <exception>
#include <functional>
#include <vector>

#if defined(__x86_64__) || defined(_M_X64)
#include <xmmintrin.h>
#endif

#include "chunk_shares.hpp"
#include "stiv/error.hpp"
#include "thread_pool.hpp"

namespace stiv {

namespace {

#if defined(__x86_64__) || defined(_M_X64)
// Bits of MXCSR that turn denormals to zero: DAZ (6) and FTZ (15). [Intel SDM vol. 1, 10.2.3]
constexpr std::uint32_t denormal_bits = 0x8040;
std::uint32_t read_control() { return _mm_getcsr(); }
void write_control(std::uint32_t control) { _mm_setcsr(control); }
#elif defined(__aarch64__)
// FPCR.FZ (24) flushes denormals to zero. [Arm ARM, FPCR]
constexpr std::uint32_t denormal_bits = 1U << 24;
std::uint32_t read_control() {
  std::uint64_t control;
  asm volatile("mrs %0, fpcr" : "=r"(control));
  return static_cast<std::uint32_t>(control);
}
void write_control(std::uint32_t control) { asm volatile("msr fpcr, %0" : : "r"(static_cast<std::uint64_t>(control))); }
#else
constexpr std::uint32_t denormal_bits = 0;
std::uint32_t read_control() { return 0; }
void write_control(std::uint32_t) {}
#endif

thread_local Execution::Owner owner_of_thread;

void lower(std::atomic<Index>& least, Index value) {
  Index seen = least.load(std::memory_order_relaxed);
  while (value < seen && !least.compare_exchange_weak(seen, value, std::memory_order_relaxed)) {
  }
}

}  // namespace

Execution::Execution(int threads) : threads_(threads > 0 ? threads : usable_processors()), owner_(owner_of_thread) {}
Execution::~Execution() = default;

void Execution::set_time_budget(double seconds, BudgetEnd end) {
  using Clock = std::chrono::steady_clock;
  deadline_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  awaits_checkpoint_ = end == BudgetEnd::after_checkpoint;
}

bool Execution::budget_used_up() const {
  return deadline_ && !awaits_checkpoint_ && std::chrono::steady_clock::now() >= *deadline_;
}

void Execution::check() const {
  if (cancel_requested()) throw Interrupted("cancelled");
  if (budget_used_up()) throw Interrupted("time budget used up");
}

void Execution::report(const char* phase, double fraction) const {
  if (progress_) progress_(phase, fraction);
}

void Execution::call_owner(const std::function<void()>& call) const {
  if (owner_)
    owner_(call);
  else
    call();
}

void Execution::set_owner(Owner owner) {
  owner_ = std::move(owner);
  owner_of_thread = owner_;
}

void Execution::for_chunks(Index count, Index chunk_size, const std::function<void(Index, Index, Index)>& work) const {
  const Index chunks = chunk_count(count, chunk_size);
  const bool shared = std::min<Index>(threads_, chunks) > 1 && !in_loop_.exchange(true, std::memory_order_acquire);
  ChunkShares shares(chunks, shared ? threads_ : 1);
  std::vector<std::exception_ptr> failures(static_cast<std::size_t>(chunks));
  std::atomic<Index> first_failure{chunks};
  const auto run = [&](int thread) {
    const FloatingPointScope floating_point;
    for (Index chunk = shares.take(thread); chunk >= 0; chunk = shares.take(thread)) {
      if (chunk > first_failure.load(std::memory_order_relaxed)) continue;
      try {
        check();
        work(chunk * chunk_size, std::min(count, (chunk + 1) * chunk_size), chunk);
      } catch (...) {
        failures[chunk] = std::current_exception();
        lower(first_failure, chunk);
      }
    }
  };
  if (shared) {
    if (!helpers_) helpers_ = std::make_unique<ThreadPool>(threads_ - 1);
    helpers_->run(std::ref(run));
    in_loop_.store(false, std::memory_order_release);
  } else {
    run(0);
  }
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
}

FloatingPointScope::FloatingPointScope() : saved_control_(read_control()), saved_rounding_(std::fegetround()) {
  std::fesetround(FE_TONEAREST);
  write_control(read_control() & ~denormal_bits);
}

FloatingPointScope::~FloatingPointScope() {
  std::fesetround(saved_rounding_);
  write_control(saved_control_);
}

}  // namespace stiv
