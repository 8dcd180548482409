#include "meshes/surface/surface_files.h"

#include <CGAL/IO/PLY.h>
#include <CGAL/Simple_cartesian.h>
#include <fmt/format.h>

#include <sstream>

#include "problem/files/files.h"
#include "problem/system/input_error.h"

namespace springproof {

Surface read_ply(const std::filesystem::path& file) {
  const auto refuse = [&](const std::string& message) {
    throw InputError(SourceLocation{file.string(), 0, 0}, message);
  };
  std::istringstream in(read_named_file(file, "a PLY file, NAME.ply"));
  std::vector<CGAL::Simple_cartesian<double>::Point_3> points;
  std::vector<std::vector<std::size_t>> polygons;
  if (!CGAL::IO::read_PLY(in, points, polygons))
    refuse("is no PLY file of vertices (x, y, z) and faces (vertex_indices), or is cut off");
  Surface surface;
  for (const auto& p : points) surface.points.emplace_back(p.x(), p.y(), p.z());
  for (const std::vector<std::size_t>& corners : polygons) {
    if (corners.size() < 3 || std::any_of(corners.begin(), corners.end(), [&](auto c) { return c >= points.size(); }))
      refuse("a face has fewer than three corners, or a corner that is not there");
    for (std::size_t c = 2; c < corners.size(); ++c)
      surface.triangles.push_back(
          {static_cast<int>(corners[0]), static_cast<int>(corners[c - 1]), static_cast<int>(corners[c])});
  }
  if (surface.triangles.empty()) refuse("has no faces (a cloud of points is no surface)");
  return surface;
}

}  // namespace springproof
