// SPDX-License-Identifier: GPL-3.0-or-later
#include "stiv/surface.hpp"

#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "module.hpp"
#include "stiv/error.hpp"

namespace py = pybind11;

namespace stiv::bindings {

namespace {

Mobility mobility_named(const std::string& name) {
  if (name == "fixed") return Mobility::fixed;
  if (name == "rigid") return Mobility::rigid;
  if (name == "deformable") return Mobility::deformable;
  throw InputError("mobility is \"fixed\", \"rigid\" or \"deformable\", not \"" + name + "\"");
}

std::shared_ptr<Surface> make_surface(Index vertex_count, Triangles triangles, Edges loose_edges,
                                      const py::array_t<Index, py::array::c_style | py::array::forcecast>& vertex_body,
                                      const std::vector<std::pair<std::string, std::string>>& bodies,
                                      std::vector<std::pair<Index, Index>> ignored,
                                      std::vector<std::vector<Index>> flip_faces) {
  SurfaceDefinition definition{vertex_count, std::move(triangles), std::move(loose_edges), {},
                               {},           std::move(ignored),   std::move(flip_faces)};
  definition.vertex_body.assign(vertex_body.data(), vertex_body.data() + vertex_body.size());
  for (const auto& [name, mobility] : bodies) definition.bodies.push_back({name, mobility_named(mobility)});
  return std::make_shared<Surface>(std::move(definition));
}

}  // namespace

void bind_surface(py::module_& module) {
  py::class_<Surface, std::shared_ptr<Surface>>(module, "Surface")
      .def(py::init(&make_surface), py::arg("vertex_count"), py::arg("triangles"), py::arg("loose_edges"),
           py::arg("vertex_body"), py::arg("bodies"), py::arg("ignored"), py::arg("flip_faces"))
      .def_property_readonly("edges", &Surface::edges)
      .def("describe_vertex", &Surface::describe_vertex, py::arg("vertex"))
      .def("describe_triangle", &Surface::describe_triangle, py::arg("triangle"))
      .def("vertex_areas", &Surface::vertex_areas, py::arg("positions"));
}

}  // namespace stiv::bindings
