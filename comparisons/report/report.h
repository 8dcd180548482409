// report.html: one self-contained page that opens offline.
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "comparisons/report/headline.h"
#include "comparisons/results/records.h"

namespace springproof {

/// Writes the page.  `head` is the verdict on the results, `results` the document written to results.json, `pictures`
/// an array with what pictures_to_json made of each case.  The page carries Chart.js, three.js and OrbitControls
/// inline, once, and links a live.html beside it.
/// @throws std::runtime_error if the file cannot be written (nothing half-written is left).
void write_report(const std::filesystem::path& file, const Headline& head, const nlohmann::json& results,
                  const nlohmann::json& pictures);

/// A page without scripts in the style of the report, `style` beside it; all are HTML but the style.
std::string plain_page(const std::string& title, const std::string& header, const std::string& main,
                       const std::string& style = "");

/// JSON escaped for use inside <script>.
std::string script_json(const nlohmann::json& json);

/// Puts values[name] in place of each @name@, in one pass: inserted text is not searched again.
/// @throws std::logic_error naming a placeholder that has no value.
std::string filled(std::string_view text, const std::map<std::string_view, std::string>& values);

/// Writes the surface of a run as binary glTF, deformed by its morph targets: of a motion its frames, in real time;
/// else the final state, to which the body goes and returns in two seconds.  Lengths in metres, z upwards as in the
/// case (glTF has y: the node is turned).
/// @param picture whose arrays fit each other
/// @throws std::runtime_error if the file cannot be written.
void write_gltf(const std::filesystem::path& file, const Picture& picture);

/// Writes FOLDER/RUN.glb for each run of a case with a picture: the true surface where there is one.
/// @throws std::runtime_error if a file cannot be written.
void write_gltf(const CaseResult& result, const std::filesystem::path& folder);

}  // namespace springproof
