// STL files, and the checks and repairs of the surface.  What passes them is closed, of triangles, and holds a volume.
#include <map>

#include "fuzz/reader.h"
#include "meshes/surface/surface_check.h"
#include "meshes/surface/surface_files.h"
#include "problem/system/input_error.h"

namespace {

bool is_closed(const springproof::Surface& surface) {
  std::map<std::pair<int, int>, int> sides;  // of an edge, both ways
  for (const auto& t : surface.triangles)
    for (int i = 0; i < 3; ++i) ++sides[{t[i], t[(i + 1) % 3]}];
  for (const auto& [edge, times] : sides)
    if (times != 1 || !sides.contains({edge.second, edge.first})) return false;
  return true;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace springproof;
  return fuzz::read_or_refuse<InputError>([&] {
    const CheckedSurface checked = check_surface(parse_stl(fuzz::view(data, size), "body.stl"), "body.stl");
    fuzz::require(is_closed(checked.surface), "each edge has two facets that face the same way");
    fuzz::require(volume(checked.surface) > 0, "the volume is positive");
  });
}
