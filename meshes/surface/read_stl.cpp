// Apart from the parser, which also runs in a browser.
#include "meshes/surface/surface_files.h"
#include "problem/files/files.h"

namespace springproof {

Surface read_stl(const std::filesystem::path& file) {
  return parse_stl(read_named_file(file, "an STL file, NAME.stl"), file);
}

}  // namespace springproof
