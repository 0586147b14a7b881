// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <cstdlib>  // defines __GLIBC__
#include <fstream>
#include <memory>
#include <vector>

#include "editing/sessions.hpp"

#if defined(__GLIBC__)
#include <malloc.h>
#include <unistd.h>
#endif

using namespace stiv;
using namespace stiv::tests;

TEST_CASE("session memory: accepted surfaces stay in place, so that a long session does not fragment the heap") {
  const Scene scene = two_sheets();
  EditSession session = session_of(scene);
  const double *const surface = session.surface().data(), *const controls = session.controls().data();
  const auto stays = [&] { return session.surface().data() == surface && session.controls().data() == controls; };
  Execution execution(1);
  for (const double depth : {0.2, 0.7, 0.4}) {
    session.drag(moved(scene.controls, upper_sheet, {0, 0, -depth}), execution);
    CHECK(stays());
  }
  session.settle(execution);
  CHECK(stays());
  session.edit(moved(scene.controls, upper_sheet, {0, 0, -1}), execution);
  CHECK(stays());
  Execution cancelled(1);
  cancelled.cancel_when([] { return true; });
  CHECK(session.edit(scene.controls, cancelled).status == EditStatus::cancelled);
  CHECK(stays());
  session.restore(scene.controls);
  CHECK(stays());
  CHECK(session.surface() == scene.controls);  // each vertex is a control
}

#if defined(__GLIBC__) && __GLIBC_PREREQ(2, 33)
namespace {

std::size_t resident_bytes() {
  std::size_t whole = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> whole >> resident;
  return resident * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

constexpr std::size_t hole = 1 << 16, holes = 256;

/// Blocks in use, with as many holes between them.
std::vector<std::unique_ptr<char[]>> blocks_with_holes() {
  std::vector<std::unique_ptr<char[]>> blocks(2 * holes);
  for (auto &block : blocks) block = std::make_unique<char[]>(hole);
  for (std::size_t k = 0; k < holes; ++k) blocks[2 * k].reset();
  return blocks;
}

}  // namespace

TEST_CASE("session memory: a restoration and the end of a drag return free pages to the system") {
  const Scene scene = two_sheets();
  EditSession session = session_of(scene);
  for (const bool restores : {true, false}) {
    const std::size_t used = mallinfo2().uordblks;
    const auto blocks = blocks_with_holes();
    if (mallinfo2().uordblks < used + hole * holes) return;  // a sanitizer allocates
    const std::size_t before = resident_bytes();
    if (restores)
      session.restore(scene.controls);
    else
      session.end_drag();
    CHECK(resident_bytes() + hole * holes * 3 / 4 < before);
  }
}
#endif
