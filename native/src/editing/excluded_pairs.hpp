// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "editing/facing_parts.hpp"
#include "editing/surface_parts.hpp"
#include "stiv/acceptance/intersections.hpp"
#include "stiv/detection/event.hpp"
#include "stiv/surface.hpp"

namespace stiv {

/// Number of excluded pairs that intersect. Those that only rounding makes intersect do not count: pairs that touched
/// at the start, and others that did not intersect there, as long as their depth is that of rounding.
struct IntersectionCount {
  std::size_t deep = 0;
  std::size_t shallow = 0;  ///< with the depth of rounding at the start, so that rounding decides whether they still do
};

/// Pairs of triangles that may intersect: the given ones, pairs next to them that touch, and other pairs of the same
/// bodies that touch, which may intersect no deeper than rounding. The same holds for given pairs of one body whose
/// parts only touch: those of two connected components, or of one, without a pair that is deeper at the start, or in
/// one plane with both insides on the same side. Pairs of two bodies that may touch are excluded in the same way, if
/// both parts are closed. An event belongs to every pair of a triangle at its first side and one at its second. It is
/// ignored only if each of these pairs is excluded, so that all other pairs stay guarded. (mathematics.md, "Excluded
/// pairs")
class ExcludedPairs {
 public:
  /// Pairs and bodies that an edit excludes.
  struct Given {
    IndexPairs pairs;
    bool parts_may_cut = false;   ///< no parts of a body count as only touching
    std::vector<Index> touching;  ///< bodies that may touch each other
    IndexPairs overlapping;       ///< pairs of bodies, smaller number first, sorted, that may not count as touching
    std::function<double(Index, Index)> separation;  ///< the minimum distance of two bodies
  };

  /// Two triangles touch if they are apart at the start, but nearer than `least`, the least separation that survives
  /// storing. Where a curve of intersection passes an edge so closely, it cannot be kept on its side of the edge. Only
  /// neighbors of the triangles of a given pair may intersect deeper. No pair that intersects at the start is added.
  /// @param start of all vertices, as stored: rounding decides whether faces that touch intersect, so positions that
  /// are moved to another origin would count as others
  /// @throws InputError: a triangle out of range, or a triangle with itself
  ExcludedPairs(std::shared_ptr<const Surface> surface, const Given& given, const PositionsView& start, double least,
                Execution& execution);

  bool empty() const { return all_.empty(); }
  const IndexPairs& pairs() const { return all_; }  ///< sorted, with the smaller index first

  /// The positions of each vertex at the start and the end of a step.
  struct Step {
    std::function<Vector3(Index)> from, to;
  };

  /// Removes the events that belong only to excluded pairs. Those of pairs that touch stay if their primitives are
  /// further apart than rounding at the end of the step: they have passed through each other. So do those of loose
  /// edges and vertices that touched at the start, and those of parts that only touched there, unless a plane parts
  /// their primitives at both ends of the step.
  /// @param start positions of all vertices at the start of the session, about any origin; those of the step are about
  /// the same one
  void remove_from(Events& events, const PositionsView& start, const Step& step) const;

  /// Adds an event for each pair of parts that only touch at the start of a session, and that intersects deeper than
  /// rounding at the end of a step, or of which one has passed the other: a plane that parts the two
  /// triangles at the start of the step. Detection finds no time at which triangles begin to touch that already do.
  /// @param from, to all vertices of the surface
  void add_contacts(Events& events, const Positions& from, const Positions& to) const;

  /// The pairs, sorted and with the smaller index first, that are not excluded, or intersect too deeply at q; and one
  /// of parts that only touched at the start, if one has passed the other.
  IndexPairs others(const IndexPairs& pairs, const PositionsView& q) const;

  /// Counts pairs that intersect at q, sorted.
  IntersectionCount count(const IndexPairs& pairs, const PositionsView& q) const;

  /// Do more pairs intersect than before, or than at the start? A pair may begin if a shallow one has ended.
  bool are_more(const IntersectionCount& now, const IntersectionCount& before) const;

 private:
  /// Distances below it are rounding: away from the start, coordinates may be larger and round more.
  double rounding() const { return rounding_; }
  double rounding_of(const IndexPairs& contacts, const PositionsView& start) const;
  void divide_given(const IndexPairs& pairs, const PositionsView& start);
  IndexPairs contacts_of(const Given& given, const PositionsView& start, Execution& execution) const;
  void take_flush(const SurfaceParts& parts, const PositionsView& start);
  void take_contacts(const IndexPairs& contacts, const SurfaceParts& parts, const PositionsView& start);
  void take_contact_planes(const Given& given, const SurfaceParts& parts, const PositionsView& start);
  void list_triangles_around_vertices();
  std::optional<Vector3> common_parting(const std::vector<FacingParts::Parting>& partings,
                                        const std::pair<Index, Index>& parts, const std::array<Index, 3>& first,
                                        const std::array<Index, 3>& second, const PositionsView& from) const;
  IndexPairs pairs_inside(const IndexPairs& pairs, const SurfaceParts& parts, const PositionsView& start) const;
  void add_touching(const PositionsView& start);
  std::vector<Index> with_neighbors(Index triangle) const;
  void find_others_that_touch(const PositionsView& start, Execution& execution);
  IndexPairs bodies_of(const IndexPairs& pairs) const;
  bool covers(const Event& event, const PositionsView& start, const Step& step) const;
  bool stays_on_its_side(const Event& event, const std::vector<Index>& first, const std::vector<Index>& second,
                         const Step& step) const;
  double overlap_along(const Event& event, const Vector3& direction,
                       const std::function<Vector3(Index)>& position) const;
  std::vector<Index> triangles_with(const Index* begin, const Index* end) const;

  std::shared_ptr<const Surface> surface_;
  double least_, rounding_;
  IndexPairs bodies_;                       // of the given pairs, smaller index first, sorted
  IndexPairs pairs_;                        // without limits
  IndexPairs deep_, shallow_;               // those that intersect at the start, shallow: no deeper than rounding
  IndexPairs flush_;                        // pairs of parts that only touch, and others in the planes of contact
  IndexPairs shallow_only_;                 // these, and others that touch: never deeper than rounding
  IndexPairs all_;                          // all of these
  FacingParts facing_;                      // of the flush pairs
  IndexPairs flush_parts_;                  // of each flush pair: the components of its triangles
  std::vector<std::vector<Index>> around_;  // triangles of each vertex; empty without pairs
};

}  // namespace stiv
