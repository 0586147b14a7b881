// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "deformation/metric/sparse_factor.hpp"
#include "stiv/deformation/handles.hpp"
#include "stiv/surface.hpp"

namespace stiv {

/// The edge weights of a mesh at rest, (n, n), symmetric and positive.
SymmetricMatrix edge_weights(const Surface& mesh, const Positions& rest, EdgeWeights kind);

/// D - W, with edge weights W and D the diagonal of their row sums.
SymmetricMatrix mesh_laplacian(const SymmetricMatrix& weights);

/// L'L with L = 1 - D^-1 W, the Laplacian with rows divided by their diagonal; zero rows for vertices without edges.
SymmetricMatrix squared_laplacian(const SymmetricMatrix& weights);

}  // namespace stiv
