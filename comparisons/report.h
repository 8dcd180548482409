// report.html: one self-contained page that opens offline.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

namespace springproof {

/// Writes the page.  `results` is the document written to results.json, `pictures` an array of one entry per case
/// ({"case": name, "pictures": [...]}), as made by pictures_to_json.
/// The page carries Chart.js, three.js and OrbitControls inline, once.
/// @throws std::runtime_error if the file cannot be written (nothing half-written is left).
void write_report(const std::filesystem::path& file, const nlohmann::json& results, const nlohmann::json& pictures);

}  // namespace springproof
