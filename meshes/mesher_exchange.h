// What travels between a caller and `springproof-mesh`: a request as JSON, the answer as CBOR whose arrays are the
// bytes in memory (both programs run on one machine).
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "meshes/mesher.h"

namespace springproof {

nlohmann::json to_json(const MeshRequest& request);

/// @throws std::runtime_error if it is no request.
MeshRequest mesh_request_from_json(const nlohmann::json& json);

std::string to_cbor(const MeshedBody& body);

/// The answer when there is no body.
std::string refusal_to_cbor(const std::string& message);

/// @throws InputError: the answer is a refusal.
/// @throws std::runtime_error: it is no answer.
MeshedBody answer_from_cbor(const std::string& bytes);

/// ".stl" of "Part.STL".
std::string extension_of(const std::filesystem::path& file);

}  // namespace springproof
