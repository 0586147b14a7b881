// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stiv/acceptance/intersections.hpp"

namespace stiv {

/// (N) nonzero for the vertices of a part.
using Marks = std::vector<unsigned char>;

/// What each intersecting pair consists of: the vertices of its two sides, behind one another.
std::vector<std::vector<Index>> vertices_of_pairs(const Surface& surface, const StaticPairs& pairs);

/// Bodies of any pair, ascending.
std::vector<Index> bodies_in_pairs(const Surface& surface, const std::vector<std::vector<Index>>& pairs);

/// Bodies that every pair has a vertex of: closed ones first, then ascending.
std::vector<Index> bodies_in_all_pairs(const Surface& surface, const std::vector<std::vector<Index>>& pairs);

/// Vertices of these bodies among those of `among`.
Marks marks_of_bodies(const Surface& surface, const std::vector<Index>& bodies, const Marks& among);

/// Vertices of each connected component that takes part in a pair, among those of `among`; smaller ones first.
std::vector<Marks> components_in_pairs(const Surface& surface, const std::vector<std::vector<Index>>& pairs,
                                       const Marks& among);

/// Vertices up to `rings` edges away from a pair, among those of `among`.
Marks region_around(const Surface& surface, const std::vector<std::vector<Index>>& pairs, int rings,
                    const Marks& among);

}  // namespace stiv
