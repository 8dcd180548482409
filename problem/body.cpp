#include "problem/body.h"

#include <cctype>
#include <filesystem>

namespace springproof {

bool Body::is_script() const {
  std::string extension = std::filesystem::path(geo).extension();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return extension != ".stl" && extension != ".msh" && extension != ".step" && extension != ".stp" &&
         extension != ".brep";
}

}  // namespace springproof
