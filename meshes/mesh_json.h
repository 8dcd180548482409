// A mesh on its way between programs.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "meshes/mesh.h"

namespace springproof {

/// Arrays as binary values of the machine's own numbers: for CBOR, between programs of one machine.
nlohmann::json to_json(const Mesh& mesh);

/// @throws nlohmann::json::exception, std::runtime_error if it is no mesh.
Mesh mesh_from_json(const nlohmann::json& json);

}  // namespace springproof
