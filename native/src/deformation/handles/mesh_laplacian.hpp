// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "deformation/metric/sparse_factor.hpp"
#include "stiv/deformation/handles.hpp"
#include "stiv/surface.hpp"

namespace stiv {

/// The weights of a mesh's edges at rest, (n, n), symmetric, all positive.
SymmetricMatrix edge_weights(const Surface& mesh, const Positions& rest, EdgeWeights kind);

/// D - W, with D the sums of the rows of the edges' weights W.
SymmetricMatrix mesh_laplacian(const SymmetricMatrix& weights);

/// L'L of the Laplacian whose rows are divided by their diagonal, L = 1 - D^-1 W; zero for vertices without edges.
SymmetricMatrix squared_laplacian(const SymmetricMatrix& weights);

}  // namespace stiv
