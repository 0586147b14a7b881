// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <mutex>
#include <optional>

#include "stiv/deformation/observed.hpp"

namespace stiv {

/// A function of the caller, called by one thread at a time. Its last value is stored.
class StoredEvaluation {
 public:
  StoredEvaluation(Evaluation evaluate, Index vertex_count);

  /// f(p), (n, 3). @throws Interrupted; InfeasibleError if f has no value; InputError for another size
  Positions surface(const Controls& p, const Execution& execution) const;

 private:
  /// The value of the function at some controls.
  struct Value {
    Controls controls;
    std::optional<Positions> surface;
  };

  std::optional<Value> stored(const Controls& p) const;
  Value evaluated(const Controls& p, const Execution& execution) const;

  Evaluation evaluate_;
  Index vertex_count_;
  mutable std::optional<Value> last_;
  mutable std::mutex mutex_;  ///< of the last value
  mutable std::mutex calling_;
};

}  // namespace stiv
