// The files that a body is made from.
#pragma once

#include <filesystem>
#include <set>

namespace springproof {

/// The file and, as gmsh scripts may include or merge others, every file that is named in one of its strings, those
/// files' own too. A '%' in a name stands for anything; names that a script puts together from pieces are not seen.
std::set<std::filesystem::path> files_behind(const std::filesystem::path& body);

}  // namespace springproof
