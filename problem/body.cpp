#include "problem/body.h"

#include <cctype>
#include <filesystem>

namespace springproof {

const std::vector<std::string>& body_file_endings() {
  static const std::vector<std::string> endings = {".geo", ".stl", ".obj", ".ply", ".msh", ".step", ".stp", ".brep"};
  return endings;
}

namespace {

std::string ending_of(const std::string& file) {
  std::string ending = std::filesystem::path(file).extension();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
  return ending;
}

}  // namespace

bool Body::is_script() const {
  const auto& endings = body_file_endings();
  return std::find(endings.begin() + 1, endings.end(), ending_of(geo)) == endings.end();
}

bool Body::states_its_unit() const { return ending_of(geo) == ".step" || ending_of(geo) == ".stp"; }

}  // namespace springproof
