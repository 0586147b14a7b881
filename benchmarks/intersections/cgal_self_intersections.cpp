// SPDX-License-Identifier: GPL-3.0-or-later
// cgal_self_intersections FILE.off REPEATS: CGAL's static test of a triangle mesh, on one thread. One line of JSON: the
// number of pairs found, and milliseconds of processor time, least of the repeats, for all pairs and for the first one.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/IO/polygon_soup_io.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <iostream>
#include <iterator>
#include <limits>
#include <utility>
#include <vector>

namespace processing = CGAL::Polygon_mesh_processing;
using Mesh = CGAL::Surface_mesh<CGAL::Exact_predicates_inexact_constructions_kernel::Point_3>;

template <class Work>
double milliseconds(const Work& work) {
  const std::clock_t start = std::clock();
  work();
  return 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

int main(int argc, char** argv) {
  std::vector<Mesh::Point> points;
  std::vector<std::vector<std::size_t>> faces;
  if (argc != 3 || !CGAL::IO::read_polygon_soup(argv[1], points, faces)) return EXIT_FAILURE;
  processing::orient_polygon_soup(points, faces);  // parts what is not manifold
  Mesh mesh;
  processing::polygon_soup_to_polygon_mesh(points, faces, mesh);
  double all = std::numeric_limits<double>::infinity(), first = all;
  std::size_t count = 0;
  for (int repeat = 0; repeat < std::atoi(argv[2]); ++repeat) {
    all = std::min(all, milliseconds([&] {
                     std::vector<std::pair<Mesh::Face_index, Mesh::Face_index>> pairs;
                     processing::self_intersections(mesh, std::back_inserter(pairs));
                     count = pairs.size();
                   }));
    first = std::min(first, milliseconds([&] { processing::does_self_intersect(mesh); }));
  }
  std::cout << "{\"pairs\": " << count << ", \"all\": " << all << ", \"first\": " << first << "}\n";
  return EXIT_SUCCESS;
}
