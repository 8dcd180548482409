// Writes the findings as an HTML page, with the report's charts and colours.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

namespace springproof::bench {

/// @throws std::runtime_error if it cannot be written.
void write_page(const std::filesystem::path& file, const nlohmann::json& document);

}  // namespace springproof::bench
