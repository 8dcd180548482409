#include "meshes/gmsh/file_kind.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <string_view>

#include "meshes/gmsh/session.h"
#include "meshes/mesher/mesher_exchange.h"

namespace springproof {
namespace {

/// How files of an ending begin; `within` so many bytes.
struct Beginning {
  std::string_view extension, mark;
  std::size_t within;
  const char* words;
};

constexpr Beginning beginnings[] = {
    {".msh", "$MeshFormat", 0, "a gmsh mesh, which begins with $MeshFormat"},
    {".step", "ISO-10303-21", 256, "a STEP file, which begins with ISO-10303-21"},
    {".stp", "ISO-10303-21", 256, "a STEP file, which begins with ISO-10303-21"},
    {".brep", "CASCADE Topology", 256, "a BREP file, which begins with CASCADE Topology"},
};

std::string first_bytes(const std::filesystem::path& file, std::size_t count) {
  std::ifstream in(file, std::ios::binary);
  std::string bytes(count, '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(count));
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  return bytes;
}

}  // namespace

void require_kind(const std::filesystem::path& file) {
  const std::string extension = extension_of(file);
  const auto* kind = std::find_if(std::begin(beginnings), std::end(beginnings),
                                  [&](const Beginning& b) { return b.extension == extension; });
  if (kind == std::end(beginnings)) return;
  if (first_bytes(file, kind->within + kind->mark.size()).find(kind->mark) == std::string::npos)
    refuse(file, fmt::format("is not what its ending says (allowed: {}; a script for gmsh ends in .geo)", kind->words));
}

}  // namespace springproof
