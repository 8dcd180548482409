// What travels between a caller and `springproof-mesh`: CBOR, which takes file names of any bytes, with arrays as the
// bytes in memory (both programs run on one machine).
#pragma once

#include <string>

#include "meshes/mesher/mesher.h"

namespace springproof {

std::string to_cbor(const MeshRequest& request);

/// @throws std::exception if it is no request.
MeshRequest mesh_request_from_cbor(const std::string& bytes);

std::string to_cbor(const MeshedBody& body);

/// The answer when there is no body.
std::string refusal_to_cbor(const std::string& message);

/// @throws InputError: the answer is a refusal.
/// @throws std::runtime_error: it is no answer.
MeshedBody answer_from_cbor(const std::string& bytes);

/// A surface as a mesh without cells, its triangles a patch of this name.
Mesh mesh_of(const Surface& surface, const std::string& patch);

/// ".stl" of "Part.STL".
std::string extension_of(const std::filesystem::path& file);

/// Whether files of this extension hold a surface alone.
bool is_surface_file(const std::string& extension);

}  // namespace springproof
