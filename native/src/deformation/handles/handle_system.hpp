// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "deformation/handles/handle_partition.hpp"
#include "deformation/metric/sparse_factor.hpp"

namespace stiv {

/// K of the free vertices plus the pulls of soft handles, (free, free).
SymmetricMatrix free_stiffness(const HandleDefinition& definition, const HandlePartition& partition,
                               const SymmetricMatrix& stiffness);

/// From displacements of handles to right-hand sides, (free, m): pulls of soft handles, minus the columns of K of hard
/// ones.
SymmetricMatrix drive_matrix(const HandleDefinition& definition, const HandlePartition& partition,
                             const SymmetricMatrix& stiffness);

/// Rows with an entry, ascending.
std::vector<Index> rows_in_use(const SymmetricMatrix& matrix);

/// The given rows of a matrix, ascending.
SymmetricMatrix selected_rows(const SymmetricMatrix& matrix, const std::vector<Index>& rows);

}  // namespace stiv
