// Self-contained HTML pages: a template filled with values and JSON.
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace springproof {

/// JSON escaped for use inside <script>.
std::string script_json(const nlohmann::json& json);

/// Puts values[name] in place of each @name@, in one pass: inserted text is not searched again.
/// @throws std::logic_error naming a placeholder that has no value.
std::string filled(std::string_view text, const std::map<std::string_view, std::string>& values);

}  // namespace springproof
