// report.html: one self-contained page that opens offline.
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "comparisons/report/headline.h"

namespace springproof {

/// Writes the page.  `head` is the verdict on the results, `results` the document written to results.json, `pictures`
/// an array with what pictures_to_json made of each case.  The page carries Chart.js, three.js and OrbitControls
/// inline, once, and links a live.html beside it.
/// @throws std::runtime_error if the file cannot be written (nothing half-written is left).
void write_report(const std::filesystem::path& file, const Headline& head, const nlohmann::json& results,
                  const nlohmann::json& pictures);

/// JSON escaped for use inside <script>.
std::string script_json(const nlohmann::json& json);

/// Puts values[name] in place of each @name@, in one pass: inserted text is not searched again.
/// @throws std::logic_error naming a placeholder that has no value.
std::string filled(std::string_view text, const std::map<std::string_view, std::string>& values);

}  // namespace springproof
