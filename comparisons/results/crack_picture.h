// The cracks of a dried body seen from above, as SVG.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "comparisons/results/records.h"

namespace springproof {

/// A stroke in the plane [m].
struct Stroke {
  double x0, y0, x1, y1;
  double age = 0;  ///< of a crack: 0 the first, 1 the last
};

/// Springs grey, cracks from dark red (first) to orange (last); y upwards.  Coordinates are rounded to 1/2000 of the
/// larger extent.  The text holds no names from outside.
std::string crack_svg(const std::vector<Stroke>& springs, const std::vector<Stroke>& cracks);

/// Whether the text is one that crack_svg() writes, to the last letter but for the numbers: nothing in it can run.
bool is_crack_svg(std::string_view text);

/// CASE-cracks-MODEL-CELLS-nuNU.svg
std::string crack_file(const std::string& case_name, const RunKey& key);

/// Writes CASE-cracks-MODEL-CELLS.svg of every record into the folder.
/// @throws std::runtime_error if a file cannot be written.
void write_crack_pictures(const std::vector<CaseResult>& results, const std::filesystem::path& folder);

}  // namespace springproof
