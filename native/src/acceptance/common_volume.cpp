// SPDX-License-Identifier: GPL-3.0-or-later
#include "acceptance/common_volume.hpp"

#include <algorithm>
#include <cmath>

#include "acceptance/crossings.hpp"

namespace stiv {

namespace {

/// Where two bodies cross: piercings sorted by their edges, each once.
struct Crossings {
  std::vector<Piercing> piercings;
  std::vector<Cut> cuts;
  bool in_general_position = true;

  void sort() {
    const auto key = [](const Piercing& p) { return std::tuple(p.edge, p.triangle); };
    std::sort(piercings.begin(), piercings.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
    const auto same = [&](const auto& a, const auto& b) { return key(a) == key(b); };
    piercings.erase(std::unique(piercings.begin(), piercings.end(), same), piercings.end());
  }

  /// Calls visit(piercing) for those of an edge, smaller vertex first.
  template <class Visit>
  void along(const std::array<Index, 2>& edge, const Visit& visit) const {
    const auto before = [](const Piercing& p, const std::array<Index, 2>& e) { return p.edge < e; };
    for (auto p = std::lower_bound(piercings.begin(), piercings.end(), edge, before);
         p != piercings.end() && p->edge == edge; ++p)
      visit(*p);
  }
};

std::array<Index, 2> edge_between(Index a, Index b) { return {std::min(a, b), std::max(a, b)}; }

/// How often the other body winds around each vertex of one, and the integrals over the surface of that one.
class Side {
 public:
  Side(const Surface& surface, const ClosedBody& body, const ClosedBody& other, const Crossings& crossings,
       const Positions& q)
      : surface_(surface), body_(body), other_(other), crossings_(crossings), q_(q) {}

  /// False where winding numbers contradict each other: something touches.
  bool find_windings() {
    windings_.assign(static_cast<std::size_t>(q_.rows()), 0);
    Eigen::AlignedBox3d box;
    for (const auto& edge : other_.edges)
      for (const Index vertex : edge) box.extend(Vector3(q_.row(vertex)));
    for (const Index seed : body_.seeds) {
      const Vector3 point = q_.row(seed);
      const double number = box.contains(point) ? winding_number(surface_, other_, q_, point) : 0;
      const double whole = std::round(number);
      if (!(std::abs(number - whole) < 0.25)) return false;
      winding(seed) = static_cast<int>(whole);
    }
    for (const auto& [from, to] : body_.walk) winding(to) = winding(from) + gained(from, to);
    return std::all_of(body_.edges.begin(), body_.edges.end(), [&](const auto& edge) {
      return winding(edge[1]) == winding(edge[0]) + gained(edge[0], edge[1]);
    });
  }

  /// Adds the integral of w x.n / 3 over the surface, and that of |w|.
  void add_to(CommonVolume& sum) const {
    const bool is_crossed = !crossings_.cuts.empty();
    std::vector<double> cut_away = is_crossed ? areas_cut_away() : std::vector<double>();
    for (std::size_t k = 0; k < body_.triangles.size(); ++k) {
      const Index triangle = body_.triangles[k];
      const double area = area_by_edge(triangle) - (is_crossed ? cut_away[k] : 0);
      sum.volume += area * unit_normal(triangle).dot(corner(triangle, 0)) / 3;
      sum.area += std::abs(area);
    }
  }

 private:
  int& winding(Index vertex) { return windings_[static_cast<std::size_t>(vertex)]; }
  int winding(Index vertex) const { return windings_[static_cast<std::size_t>(vertex)]; }
  Vector3 corner(Index triangle, Index k) const { return q_.row(surface_.triangles()(triangle, k)); }
  Vector3 normal(Index triangle) const {
    const Vector3 origin = corner(triangle, 0);
    return (corner(triangle, 1) - origin).cross(corner(triangle, 2) - origin);
  }
  Vector3 unit_normal(Index triangle) const { return normal(triangle).stableNormalized(); }

  int gained(Index from, Index to) const {
    int sum = 0;
    crossings_.along(edge_between(from, to),
                     [&](const Piercing& piercing) { sum += from < to ? piercing.step : -piercing.step; });
    return sum;
  }

  /// The mean of w over the edge opposite to the first corner, times the triangle's area: by the divergence theorem in
  /// its plane, seen from that corner, the part of the border in the integral of w.
  double area_by_edge(Index triangle) const {
    const Index from = surface_.triangles()(triangle, 1), to = surface_.triangles()(triangle, 2);
    double mean = winding(from);
    crossings_.along(edge_between(from, to), [&](const Piercing& piercing) {
      mean += from < to ? piercing.step * (1 - piercing.at) : -piercing.step * piercing.at;
    });
    return mean == 0 ? 0 : mean * normal(triangle).norm() / 2;
  }

  /// And the part of the segments along which w jumps.
  std::vector<double> areas_cut_away() const {
    std::vector<double> areas(body_.triangles.size(), 0);
    for (const Cut& cut : crossings_.cuts) {
      const bool is_first = std::binary_search(body_.triangles.begin(), body_.triangles.end(), cut.triangles[0]);
      const Index triangle = cut.triangles[is_first ? 0 : 1], other = cut.triangles[is_first ? 1 : 0];
      const Vector3 n = unit_normal(triangle), back = -normal(other), along = cut.ends[1] - cut.ends[0];
      Vector3 across = n.cross(along);  // of the length of the segment
      if (across.dot(back) < 0) across = -across;
      const auto place = std::lower_bound(body_.triangles.begin(), body_.triangles.end(), triangle);
      areas[static_cast<std::size_t>(place - body_.triangles.begin())] +=
          across.dot(cut.ends[0] - corner(triangle, 0)) / 2;
    }
    return areas;
  }

  const Surface& surface_;
  const ClosedBody &body_, &other_;
  const Crossings& crossings_;
  const Positions& q_;
  std::vector<int> windings_;
};

std::array<Index, 2> bodies_of(const Surface& surface, const std::pair<Index, Index>& pair) {
  const Index a = surface.body_of(surface.triangles()(pair.first, 0));
  const Index b = surface.body_of(surface.triangles()(pair.second, 0));
  return {std::min(a, b), std::max(a, b)};
}

std::optional<CommonVolume> common_volume(const Surface& surface, const ClosedBody& a, const ClosedBody& b,
                                          const Crossings& crossings, const Positions& q) {
  if (!crossings.in_general_position) return std::nullopt;
  Side first(surface, a, b, crossings, q), second(surface, b, a, crossings, q);
  if (!first.find_windings() || !second.find_windings()) return std::nullopt;
  CommonVolume sum;
  first.add_to(sum);
  second.add_to(sum);
  sum.volume = std::abs(sum.volume);  // one body may face inward
  return sum;
}

}  // namespace

CommonVolumes::CommonVolumes(std::shared_ptr<const Surface> surface, const IndexPairs& pairs)
    : surface_(std::move(surface)) {
  for (const auto& pair : pairs) bodies_.push_back(bodies_of(*surface_, pair));
  std::sort(bodies_.begin(), bodies_.end());
  bodies_.erase(std::unique(bodies_.begin(), bodies_.end()), bodies_.end());
  for (const auto& [a, b] : bodies_)
    for (const Index body : {a, b})
      if (auto closed = closed_.count(body) == 0 && a != b ? closed_body(*surface_, body) : std::nullopt)
        closed_.emplace(body, std::move(*closed));
  std::erase_if(bodies_, [&](const auto& pair) {
    return pair[0] == pair[1] || closed_.count(pair[0]) == 0 || closed_.count(pair[1]) == 0;
  });
}

std::vector<std::optional<CommonVolume>> CommonVolumes::at(const Positions& q, const IndexPairs& intersecting) const {
  std::vector<Crossings> crossings(bodies_.size());
  for (const auto& pair : intersecting) {
    const auto found = std::lower_bound(bodies_.begin(), bodies_.end(), bodies_of(*surface_, pair));
    if (found == bodies_.end() || *found != bodies_of(*surface_, pair)) continue;
    Crossings& here = crossings[static_cast<std::size_t>(found - bodies_.begin())];
    const auto cut = crossing(*surface_, q, {pair.first, pair.second}, here.piercings);
    here.in_general_position = here.in_general_position && cut.has_value();
    if (cut) here.cuts.push_back(*cut);
  }
  std::vector<std::optional<CommonVolume>> volumes;
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    crossings[k].sort();
    volumes.push_back(common_volume(*surface_, closed_.at(bodies_[k][0]), closed_.at(bodies_[k][1]), crossings[k], q));
  }
  return volumes;
}

}  // namespace stiv
