// SPDX-License-Identifier: GPL-3.0-or-later
#include "deformation/subdivision/limit_stencils.hpp"

#include <opensubdiv/far/patchMap.h>
#include <opensubdiv/far/patchTableFactory.h>
#include <opensubdiv/far/stencilTableFactory.h>
#include <opensubdiv/far/topologyDescriptor.h>
#include <algorithm>

#include "stiv/error.hpp"

namespace stiv {

namespace {

namespace Far = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;

using Stencils = Far::StencilTableReal<double>;
using StencilFactory = Far::StencilTableFactoryReal<double>;

/// The sharpness at which an edge or vertex is infinitely sharp. (Sdc::Crease::SHARPNESS_INFINITE)
constexpr float infinite_sharpness = 10;

/// Sharp elements in OpenSubdiv's format.
struct Sharpness {
  std::vector<int> edge_ends;
  std::vector<float> edge;
  std::vector<int> vertices;
  std::vector<float> vertex;
};

/// Blender's creases in [0, 1] as sharpness: 10 crease^2, single precision.
float crease_sharpness(const std::vector<float>& creases, std::size_t k) {
  return creases.empty() ? 0 : infinite_sharpness * creases[k] * creases[k];
}

/// Sharpness added to a vertex of exactly two edges: the smaller of their sharpnesses, as in Blender's modifier.
std::vector<float> corner_sharpness(const Cage& cage) {
  const auto count = static_cast<std::size_t>(cage.vertex_count);
  std::vector<float> least(count, infinite_sharpness);
  std::vector<int> edges(count, 0);
  for (Index edge = 0; edge < cage.edges.rows(); ++edge) {
    for (const Index end : {cage.edges(edge, 0), cage.edges(edge, 1)}) {
      const auto vertex = static_cast<std::size_t>(end);
      least[vertex] = std::min(least[vertex], crease_sharpness(cage.edge_crease, static_cast<std::size_t>(edge)));
      ++edges[vertex];
    }
  }
  for (std::size_t vertex = 0; vertex < count; ++vertex)
    if (edges[vertex] != 2) least[vertex] = 0;
  return least;
}

/// The type "Simple" is the scheme with everything infinitely sharp. A face's vertex with a loose edge is sharp too.
Sharpness sharpness_of(const Cage& cage, const CageEdges& edges, const Wires& wires, bool simple) {
  Sharpness sharpness;
  for (Index edge = 0; edge < cage.edges.rows(); ++edge) {
    const float value =
        simple ? infinite_sharpness : crease_sharpness(cage.edge_crease, static_cast<std::size_t>(edge));
    if (edges.is_loose(edge) || !(value > 0)) continue;
    sharpness.edge_ends.insert(sharpness.edge_ends.end(), {cage.edges(edge, 0), cage.edges(edge, 1)});
    sharpness.edge.push_back(value);
  }
  const std::vector<float> corner = corner_sharpness(cage);
  for (Index vertex = 0; vertex < cage.vertex_count; ++vertex) {
    const auto k = static_cast<std::size_t>(vertex);
    const bool infinite = simple || wires.touches(vertex);
    const float value = infinite ? infinite_sharpness : crease_sharpness(cage.vertex_crease, k) + corner[k];
    if (!(value > 0)) continue;
    sharpness.vertices.push_back(vertex);
    sharpness.vertex.push_back(value);
  }
  return sharpness;
}

Sdc::SchemeType scheme_of(SubdivisionScheme scheme) {
  return scheme == SubdivisionScheme::loop ? Sdc::SCHEME_LOOP : Sdc::SCHEME_CATMARK;
}

Sdc::Options scheme_options(BoundarySmoothing boundary) {
  Sdc::Options options;
  options.SetVtxBoundaryInterpolation(boundary == BoundarySmoothing::all ? Sdc::Options::VTX_BOUNDARY_EDGE_ONLY
                                                                         : Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
  options.SetCreasingMethod(Sdc::Options::CREASE_UNIFORM);
  options.SetTriangleSubdivision(Sdc::Options::TRI_SUB_CATMARK);
  return options;
}

std::unique_ptr<Far::TopologyRefiner> make_refiner(const Cage& cage, const Sharpness& sharpness,
                                                   const SubdivisionOptions& options) {
  std::vector<int> corner_counts;
  for (Index face = 0; face < face_count(cage); ++face) {
    const auto [first, last] = corner_range(cage, face);
    corner_counts.push_back(last - first);
  }
  Far::TopologyDescriptor descriptor;
  descriptor.numVertices = cage.vertex_count;
  descriptor.numFaces = face_count(cage);
  descriptor.numVertsPerFace = corner_counts.data();
  descriptor.vertIndicesPerFace = cage.face_corners.data();
  descriptor.numCreases = static_cast<int>(sharpness.edge.size());
  descriptor.creaseVertexIndexPairs = sharpness.edge_ends.data();
  descriptor.creaseWeights = sharpness.edge.data();
  descriptor.numCorners = static_cast<int>(sharpness.vertex.size());
  descriptor.cornerVertexIndices = sharpness.vertices.data();
  descriptor.cornerWeights = sharpness.vertex.data();
  using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
  return std::unique_ptr<Far::TopologyRefiner>(
      Factory::Create(descriptor, Factory::Options(scheme_of(options.scheme), scheme_options(options.boundary))));
}

void refine(Far::TopologyRefiner& refiner, bool adaptive, int level) {
  if (!adaptive) return refiner.RefineUniform(Far::TopologyRefiner::UniformOptions(level));
  Far::TopologyRefiner::AdaptiveOptions options(level);
  options.useInfSharpPatch = true;
  options.considerFVarChannels = false;
  refiner.RefineAdaptive(options);
}

std::unique_ptr<const Far::PatchTable> make_patches(const Far::TopologyRefiner& refiner, int level) {
  Far::PatchTableFactory::Options options(level);
  options.SetEndCapType(Far::PatchTableFactory::Options::ENDCAP_GREGORY_BASIS);
  options.useInfSharpPatch = true;
  options.SetPatchPrecision<double>();
  return std::unique_ptr<const Far::PatchTable>(Far::PatchTableFactory::Create(refiner, options));
}

/// Stencils of the vertices that patches refer to: with uniform refinement those of the cage and the last level, with
/// adaptive refinement those of all levels and the patches' own points.
std::unique_ptr<const Stencils> make_stencils(const Far::TopologyRefiner& refiner, const Far::PatchTable& patches,
                                              bool adaptive) {
  StencilFactory::Options options;
  options.generateOffsets = true;
  options.generateControlVerts = true;
  options.generateIntermediateLevels = adaptive;
  std::unique_ptr<const Stencils> stencils(StencilFactory::Create(refiner, options));
  if (const Stencils* local = patches.GetLocalPointStencilTable<double>())
    if (const Stencils* all = StencilFactory::AppendLocalPointStencilTable(refiner, stencils.get(), local))
      stencils.reset(all);
  return stencils;
}

}  // namespace

struct LimitStencils::Tables {
  std::unique_ptr<const Far::PatchTable> patches;
  std::unique_ptr<const Far::PatchMap> map;
  std::unique_ptr<const Stencils> stencils;
};

LimitStencils::LimitStencils(const Cage& cage, const CageEdges& edges, const Wires& wires,
                             const SubdivisionOptions& options) {
  const auto refiner = make_refiner(cage, sharpness_of(cage, edges, wires, options.simple), options);
  if (!refiner) throw InputError("cage: OpenSubdiv cannot subdivide it; remove degenerate faces");
  const bool adaptive = options.limit_surface;
  const int level = options.simple ? 1 : adaptive ? options.quality : options.levels;
  refine(*refiner, adaptive, level);
  auto tables = std::make_unique<Tables>();
  tables->patches = make_patches(*refiner, level);
  tables->map = std::make_unique<const Far::PatchMap>(*tables->patches);
  tables->stencils = make_stencils(*refiner, *tables->patches, adaptive);
  tables_ = std::move(tables);
}

LimitStencils::~LimitStencils() = default;

void LimitStencils::add_point(const SurfaceLocation& location, WeightRows& rows) const {
  const Far::PatchTable::PatchHandle* patch = tables_->map->FindPatch(location.ptex_face, location.s, location.t);
  if (patch == nullptr)
    throw InputError("cage: OpenSubdiv has no patch for face " + std::to_string(location.ptex_face));
  std::array<double, 20> basis;  // Gregory patches have the most points: 20
  tables_->patches->EvaluateBasis(*patch, location.s, location.t, basis.data());
  const Far::ConstIndexArray points = tables_->patches->GetPatchVertices(*patch);
  for (int k = 0; k < points.size(); ++k) {
    const Far::StencilReal<double> stencil = tables_->stencils->GetStencil(points[k]);
    for (int j = 0; j < stencil.GetSize(); ++j)
      rows.add(stencil.GetVertexIndices()[j], basis[at(k)] * stencil.GetWeights()[j]);
  }
}

}  // namespace stiv
