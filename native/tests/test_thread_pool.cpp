// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>
#include <stdlib.h>  // setenv is POSIX's, not the C++ library's

#include <string>

#include "stiv/error.hpp"
#include "stiv/execution.hpp"

using namespace stiv;

namespace {

#ifdef _WIN32
int setenv(const char* name, const char* value, int) { return _putenv_s(name, value); }
int unsetenv(const char* name) { return _putenv_s(name, ""); }
#endif

/// Sets the variable for its lifetime, then restores it.
class Setting {
 public:
  explicit Setting(const char* value) {
    if (const char* before = getenv(name)) before_ = before;
    setenv(name, value, 1);
  }
  ~Setting() { before_.empty() ? unsetenv(name) : setenv(name, before_.c_str(), 1); }
  Setting(const Setting&) = delete;
  Setting& operator=(const Setting&) = delete;

 private:
  static constexpr const char* name = "STIV_THREADS";
  std::string before_;
};

}  // namespace

TEST_CASE("usable processors: no more threads than STIV_THREADS where none are asked for, as many as asked for else") {
  const int all = Execution().threads();
  CHECK(all >= 1);
  {
    const Setting one("1");
    CHECK(Execution().threads() == 1);
    CHECK(Execution(3).threads() == 3);
  }
  const Setting many("100000");
  CHECK(Execution().threads() == all);
}

TEST_CASE("usable processors: what is not a number of threads is named") {
  for (const char* value : {"0", "-1", "two", "2 "}) {
    const Setting wrong(value);
    CHECK_THROWS_WITH_AS(Execution(), doctest::Contains(value), InputError);
  }
}
