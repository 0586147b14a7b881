// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <utility>

#include "calls.hpp"
#include "stiv/job.hpp"

namespace stiv::bindings {

/// Translates the result of a job, in the thread that asks for it and with Python's lock.
using Translation = std::function<py::object()>;

/// A job as Python sees it. Its thread touches no objects of Python.
using NativeJob = Job<Translation>;

/// Starts work of the core, `Result work(Execution&)`. `translate` makes Python's object of its result.
/// Neither may hold objects of Python.
template <class Work, class Translate>
std::unique_ptr<NativeJob> start_job(int threads, Work work, Translate translate) {
  return std::make_unique<NativeJob>(
      [work = std::move(work), translate](Execution& execution) -> Translation {
        using Result = decltype(work(execution));
        const auto result = std::make_shared<Result>(work(execution));
        return [result, translate] { return py::object(translate(*result)); };
      },
      threads);
}

}  // namespace stiv::bindings
