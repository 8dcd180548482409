// The deformed surfaces of a report: what pictures_to_json wrote into report.html.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "comparisons/results/records.h"

namespace springproof {

/// Pictures of FOLDER/report.html by case ("golec_2019/torsion"): rest, displacement (to 1/65000 of its largest
/// component) and facets; none if there is no report.
/// @throws InputError if the file is no report.
std::map<std::string, std::vector<Picture>> read_pictures(const std::filesystem::path& folder);

}  // namespace springproof
