// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/surface.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "stiv/coordinate_range.hpp"
#include "stiv/error.hpp"
#include "stiv/execution.hpp"

namespace stiv {

namespace {

template <class Corners>
bool are_in_range(const Corners& corners, Index vertex_count) {
  bool outside = false;  // no early end: compilers turn this into vector code
  for (const Index* corner = corners.data(); corner != corners.data() + corners.size(); ++corner)
    outside |= (*corner < 0) | (*corner >= vertex_count);
  return !outside;
}

/// Row-wise check of corner indices: in range, and all corners of one body.
template <class Corners>
void check_corners(const SurfaceDefinition& definition, const Corners& corners, const char* what) {
  if (definition.bodies.size() == 1 && are_in_range(corners, definition.vertex_count)) return;
  for (Index row = 0; row < corners.rows(); ++row) {
    for (Index k = 0; k < corners.cols(); ++k) {
      const Index vertex = corners(row, k);
      if (vertex >= 0 && vertex < definition.vertex_count) continue;
      std::ostringstream message;
      message << what << " " << row << ": vertex index " << vertex << " is out of range 0.."
              << definition.vertex_count - 1;
      throw InputError(message.str());
    }
    const auto body = [&](Index k) { return definition.vertex_body[corners(row, k)]; };
    for (Index k = 1; k < corners.cols(); ++k) {
      if (body(k) == body(0)) continue;
      std::ostringstream message;
      message << what << " " << row << " joins two objects, \"" << definition.bodies[body(0)].name << "\" and \""
              << definition.bodies[body(k)].name << "\"; give each object its own vertices";
      throw InputError(message.str());
    }
  }
}

void fill_defaults(SurfaceDefinition& definition) {
  if (definition.bodies.empty()) definition.bodies.push_back({"surface", Mobility::deformable});
  if (definition.vertex_body.empty())
    definition.vertex_body.assign(static_cast<std::size_t>(definition.vertex_count), 0);
}

void check_bodies(const SurfaceDefinition& definition) {
  const auto count = static_cast<Index>(definition.bodies.size());
  if (definition.vertex_body.size() != static_cast<std::size_t>(definition.vertex_count)) {
    std::ostringstream message;
    message << "vertex_body has " << definition.vertex_body.size() << " entries for " << definition.vertex_count
            << " vertices";
    throw InputError(message.str());
  }
  const auto is_valid = [&](Index body) { return body >= 0 && body < count; };
  const auto fail = [&](Index body, const std::string& where) {
    std::ostringstream message;
    message << where << ": body index " << body << " is out of range 0.." << count - 1;
    throw InputError(message.str());
  };
  for (std::size_t vertex = 0; vertex < definition.vertex_body.size(); ++vertex)
    if (!is_valid(definition.vertex_body[vertex]))
      fail(definition.vertex_body[vertex], "vertex " + std::to_string(vertex));
  for (const auto& [a, b] : definition.ignored)
    for (const Index body : {a, b})
      if (!is_valid(body)) fail(body, "ignored pair");
}

/// Calls `work(smaller, larger)` for the ends of each side of a face and each loose edge, with repetitions.
template <class Work>
void for_each_side(const SurfaceDefinition& definition, const Work& work) {
  const auto side = [&](Index a, Index b) {
    if (a != b) work(std::min(a, b), std::max(a, b));
  };
  for (const auto& face : definition.triangles.rowwise())
    for (Index k = 0; k < 3; ++k) side(face[k], face[(k + 1) % 3]);
  for (const auto& edge : definition.loose_edges.rowwise()) side(edge[0], edge[1]);
}

/// The edges, sorted. A counting sort by first vertex leaves few ends to sort for each vertex.
Edges unique_edges(const SurfaceDefinition& definition) {
  std::vector<std::size_t> start(static_cast<std::size_t>(definition.vertex_count) + 1, 0);
  for_each_side(definition, [&](Index a, Index) { ++start[a]; });
  std::size_t sum = 0;
  for (std::size_t& count : start) count = sum += count;
  std::vector<Index> ends(sum);
  for_each_side(definition, [&](Index a, Index b) { ends[--start[a]] = b; });
  Edges edges(static_cast<Index>(sum), 2);
  Index row = 0;
  for (Index vertex = 0; vertex < definition.vertex_count; ++vertex) {
    const auto begin = ends.begin() + static_cast<std::ptrdiff_t>(start[vertex]);
    const auto end = ends.begin() + static_cast<std::ptrdiff_t>(start[static_cast<std::size_t>(vertex) + 1]);
    std::sort(begin, end);
    std::for_each(begin, std::unique(begin, end), [&](Index other) { edges.row(row++) << vertex, other; });
  }
  edges.conservativeResize(row, 2);
  return edges;
}

std::vector<unsigned char> meeting_bodies(const SurfaceDefinition& definition) {
  const std::vector<Body>& bodies = definition.bodies;
  const std::size_t count = bodies.size();
  std::vector<unsigned char> meets(count * count, 1);
  for (std::size_t a = 0; a < count; ++a) {
    meets[a * count + a] = bodies[a].mobility == Mobility::deformable;
    for (std::size_t b = 0; b < count; ++b)
      if (bodies[a].mobility == Mobility::fixed && bodies[b].mobility == Mobility::fixed) meets[a * count + b] = 0;
  }
  for (const auto& [a, b] : definition.ignored) {
    meets[static_cast<std::size_t>(a) * count + static_cast<std::size_t>(b)] = 0;
    meets[static_cast<std::size_t>(b) * count + static_cast<std::size_t>(a)] = 0;
  }
  return meets;
}

/// Neighbors of all vertices in compressed rows. Edges are sorted: those to larger neighbors follow each other.
void connect(const Edges& edges, Index vertex_count, std::vector<Index>& start, std::vector<Index>& neighbours) {
  const auto vertices = static_cast<std::size_t>(vertex_count);
  std::vector<Index> smaller(vertices, 0), larger(vertices, 0);  // numbers of neighbors, then where to write the next
  for (Index edge = 0; edge < edges.rows(); ++edge) {
    ++larger[edges(edge, 0)];
    ++smaller[edges(edge, 1)];
  }
  start.resize(vertices + 1);
  start[0] = 0;
  for (std::size_t vertex = 0; vertex < vertices; ++vertex) {
    const Index count = smaller[vertex];
    smaller[vertex] = start[vertex];
    start[vertex + 1] = start[vertex] + count + std::exchange(larger[vertex], start[vertex] + count);
  }
  neighbours.resize(static_cast<std::size_t>(2 * edges.rows()));
  for (Index edge = 0; edge < edges.rows(); ++edge) {
    neighbours[larger[edges(edge, 0)]++] = edges(edge, 1);
    neighbours[smaller[edges(edge, 1)]++] = edges(edge, 0);
  }
}

/// Numbers of the flip faces of every vertex.
std::vector<std::vector<Index>> flip_faces_of_vertices(const SurfaceDefinition& definition) {
  std::vector<std::vector<Index>> faces;
  if (definition.flip_faces.empty()) return faces;
  faces.resize(static_cast<std::size_t>(definition.vertex_count));
  for (std::size_t face = 0; face < definition.flip_faces.size(); ++face)
    for (const Index vertex : definition.flip_faces[face]) {
      if (vertex < 0 || vertex >= definition.vertex_count)
        throw InputError("flip face " + std::to_string(face) + ": vertex index " + std::to_string(vertex) +
                         " is out of range 0.." + std::to_string(definition.vertex_count - 1));
      std::vector<Index>& own = faces[vertex];
      if (own.empty() || own.back() != static_cast<Index>(face)) own.push_back(static_cast<Index>(face));
    }
  return faces;
}

/// Name of the body of `vertex`, and the position of `vertex` among that body's vertices.
std::pair<std::string, Index> place_in_body(const SurfaceDefinition& definition, Index vertex) {
  const Index body = definition.vertex_body[vertex];
  const auto begin = definition.vertex_body.begin();
  return {definition.bodies[body].name, static_cast<Index>(std::count(begin, begin + vertex, body))};
}

}  // namespace

Surface::Surface(SurfaceDefinition definition) : definition_(std::move(definition)) {
  if (definition_.vertex_count < 0) throw InputError("vertex count is negative");
  fill_defaults(definition_);
  check_bodies(definition_);
  check_corners(definition_, definition_.triangles, "face");
  check_corners(definition_, definition_.loose_edges, "edge");
  edges_ = unique_edges(definition_);
  meets_ = meeting_bodies(definition_);
  flip_faces_ = flip_faces_of_vertices(definition_);
  connect(edges_, vertex_count(), neighbour_start_, neighbours_);
}

std::vector<unsigned char> Surface::fixed_bodies() const {
  std::vector<unsigned char> fixed;
  for (const Body& body : bodies()) fixed.push_back(body.mobility == Mobility::fixed);
  return fixed;
}

bool Surface::in_one_flip_face(const Index* vertices, std::size_t count) const {
  const auto faces_of = [&](Index vertex) -> const std::vector<Index>& { return flip_faces_[vertex]; };
  for (const Index face : faces_of(vertices[0])) {
    const bool in_all = std::all_of(vertices + 1, vertices + count, [&](Index vertex) {
      return std::binary_search(faces_of(vertex).begin(), faces_of(vertex).end(), face);
    });
    if (in_all) return true;
  }
  return false;
}

std::vector<Index> Surface::connected_components() const {
  std::vector<Index> component(static_cast<std::size_t>(vertex_count()), -1);
  std::vector<Index> waiting;
  for (Index first = 0; first < vertex_count(); ++first) {
    if (component[at(first)] < 0) waiting.push_back(first);
    while (!waiting.empty()) {
      const Index vertex = waiting.back();
      waiting.pop_back();
      if (component[at(vertex)] >= 0) continue;
      component[at(vertex)] = first;
      waiting.insert(waiting.end(), neighbours_begin(vertex), neighbours_end(vertex));
    }
  }
  return component;
}

Eigen::VectorXd Surface::vertex_areas(const PositionsView& q) const {
  Eigen::VectorXd areas = Eigen::VectorXd::Zero(vertex_count());
  add_vertex_areas(q, 0, static_cast<Index>(triangles().rows()), areas, Execution(1));
  return areas;
}

void Surface::add_vertex_areas(const PositionsView& q, Index first, Index end, Eigen::VectorXd& areas,
                               const Execution& execution, Index first_row) const {
  constexpr Index chunk_size = 4096;
  Eigen::VectorXd thirds(end - first);
  execution.for_chunks(end - first, chunk_size, [&](Index begin, Index last, Index) {
    for (Index k = begin; k < last; ++k) {
      const auto corner = [&](Index c) -> Vector3 { return q.row(triangles()(first + k, c) - first_row); };
      thirds[k] = (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm() / 6;
    }
  });
  for (Index face = first; face < end; ++face)
    for (const Index corner : triangles().row(face)) areas[corner] += thirds[face - first];
}

std::string Surface::describe_vertex(Index vertex) const {
  const auto [name, place] = place_in_body(definition_, vertex);
  return "object \"" + name + "\", vertex " + std::to_string(place);
}

std::string Surface::describe_triangle(Index triangle) const {
  const Index body = body_of(triangles()(triangle, 0));
  Index place = 0;
  for (Index other = 0; other < triangle; ++other) place += body_of(triangles()(other, 0)) == body;
  return "object \"" + bodies()[body].name + "\", face " + std::to_string(place);
}

void Surface::check_positions(const PositionsView& q) const {
  if (q.rows() != vertex_count()) {
    std::ostringstream message;
    message << "positions have " << q.rows() << " rows, the surface has " << vertex_count() << " vertices";
    throw InputError(message.str());
  }
  for (Index vertex = 0; vertex < q.rows(); ++vertex) check_position(vertex, q.row(vertex));
}

void Surface::check_position(Index vertex, const Eigen::Ref<const Eigen::RowVector3d>& position) const {
  for (const double coordinate : position)
    if (const char* fault = coordinate_fault(coordinate)) throw InputError(describe_vertex(vertex) + ": " + fault);
}

}  // namespace stiv
