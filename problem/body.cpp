#include "problem/body.h"

#include <cctype>
#include <filesystem>

namespace springproof {

const std::vector<std::string>& body_file_endings() {
  static const std::vector<std::string> endings = {".geo", ".stl", ".obj", ".ply", ".msh", ".step", ".stp", ".brep"};
  return endings;
}

bool Body::is_script() const {
  std::string extension = std::filesystem::path(geo).extension();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  const auto& endings = body_file_endings();
  return std::find(endings.begin() + 1, endings.end(), extension) == endings.end();
}

}  // namespace springproof
