// What a file is by its contents: gmsh takes for a script whatever it does not know, and runs it.
#pragma once

#include <filesystem>

namespace springproof {

/// Holds the beginning of a .msh, .step, .stp or .brep file against its ending; other endings are let through.
/// @throws InputError
void require_kind(const std::filesystem::path& file);

}  // namespace springproof
