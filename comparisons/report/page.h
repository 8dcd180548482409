// Pages that carry everything with them: a template with values and JSON put in.
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace springproof {

/// JSON that may stand inside <script>.
std::string script_json(const nlohmann::json& json);

/// Puts values[name] in place of each @name@, in one pass: what is put in is not searched again.
/// @throws std::logic_error naming one that has no value.
std::string filled(std::string_view text, const std::map<std::string_view, std::string>& values);

}  // namespace springproof
