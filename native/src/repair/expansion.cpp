// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/repair/expansion.hpp"

#include <utility>

#include "stiv/deformation/identity.hpp"

namespace stiv {

EditResult expand(const std::shared_ptr<const Surface>& surface, const Positions& from, const Positions& target,
                  const EditOptions& options, Execution& execution) {
  return expand(surface, make_identity(surface->vertex_count()), from, target, options, execution);
}

EditResult expand(const std::shared_ptr<const Surface>& surface, const std::shared_ptr<const Deformation>& deformation,
                  const Controls& from, const Controls& target, const EditOptions& options, Execution& execution) {
  EditSession session(surface, deformation, from, options);
  EditResult edited = session.edit(target, execution);
  if (edited.status != EditStatus::corrected && edited.status != EditStatus::blocked) return edited;
  EditResult settled = session.settle(execution);
  settled.path.insert(settled.path.begin(), std::make_move_iterator(edited.path.begin()),
                      std::make_move_iterator(edited.path.end()));
  if (settled.status == EditStatus::unchanged) settled.status = edited.status;
  return settled;
}

}  // namespace stiv
