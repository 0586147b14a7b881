// SPDX-License-Identifier: GPL-3.0-or-later
#include "thread_priority.hpp"

#if defined(__linux__)
#include <sys/resource.h>
#elif defined(__APPLE__)
#include <pthread/qos.h>
#elif defined(_WIN32)
#define NOMINMAX
#include <windows.h>
#endif

namespace stiv {

void lower_thread_priority() noexcept {
#if defined(__linux__)
  constexpr int nicer = 5;  // a third to a quarter of the time of a thread that needs the same processor
  setpriority(PRIO_PROCESS, 0, getpriority(PRIO_PROCESS, 0) + nicer);  // in Linux, of this thread alone
#elif defined(__APPLE__)
  pthread_set_qos_class_self_np(QOS_CLASS_UTILITY, 0);
#elif defined(_WIN32)
  SetThreadPriority(GetCurrentThread(), THREAD_PRIORITY_BELOW_NORMAL);
#endif
}

}  // namespace stiv
