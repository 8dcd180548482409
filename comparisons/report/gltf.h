// Deformed surfaces for any viewer of glTF 2.0 (Khronos, 2021).
#pragma once

#include <filesystem>

#include "comparisons/results/records.h"

namespace springproof {

/// Writes the surface of a run as binary glTF, deformed by its morph targets: of a motion its frames, in real time;
/// else the final state, to which the body goes and returns in two seconds.  Lengths in metres, z upwards as in the
/// case (glTF has y: the node is turned).
/// @param picture whose arrays fit each other
/// @throws std::runtime_error if the file cannot be written.
void write_gltf(const std::filesystem::path& file, const Picture& picture);

/// Writes FOLDER/RUN.glb for each run of a case with a picture: the true surface where there is one.
/// @throws std::runtime_error if a file cannot be written.
void write_gltf(const CaseResult& result, const std::filesystem::path& folder);

}  // namespace springproof
