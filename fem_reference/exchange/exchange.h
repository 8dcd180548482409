// Serialisation of requests to `springproof-fem` and of its results, for exchange as CBOR.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "fem_reference/exchange/request.h"

namespace springproof::fem {

nlohmann::json to_json(const Request& request);

/// @throws InputError, std::runtime_error if it is no request.
Request request_from_json(const nlohmann::json& json);

nlohmann::json to_json(const std::vector<Solution>& solutions);
std::vector<Solution> solutions_from_json(const nlohmann::json& json);

}  // namespace springproof::fem
