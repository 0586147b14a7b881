// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "repair/caged_surface.hpp"

namespace stiv {

/// The vertices of each intersecting pair, those of its first side before those of the second.
std::vector<std::vector<Index>> vertices_of_pairs(const Surface& surface, const StaticPairs& pairs);

/// Bodies with a vertex in some pair, ascending.
std::vector<Index> bodies_in_pairs(const Surface& surface, const std::vector<std::vector<Index>>& pairs);

/// Bodies with a vertex in every pair: closed ones first, then ascending.
std::vector<Index> bodies_in_all_pairs(const Surface& surface, const std::vector<std::vector<Index>>& pairs);

/// The vertices of these bodies that `among` marks.
Marks marks_of_bodies(const Surface& surface, const std::vector<Index>& bodies, const Marks& among);

/// Each connected component with a vertex in some pair, restricted to `among`; smaller ones first.
std::vector<Marks> components_in_pairs(const Surface& surface, const std::vector<std::vector<Index>>& pairs,
                                       const Marks& among);

/// The vertices at most `rings` edges from a pair, restricted to `among`.
Marks region_around(const Surface& surface, const std::vector<std::vector<Index>>& pairs, int rings,
                    const Marks& among);

}  // namespace stiv
