// Runs work in a child process, which has its own memory and can be killed.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>

namespace springproof::bench {

/// springproof::in_child() for JSON.
/// @throws Interrupted
nlohmann::json in_child(const std::function<nlohmann::json()>& work);

}  // namespace springproof::bench
