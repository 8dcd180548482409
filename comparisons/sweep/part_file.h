// Serialises finished parts to disk, so that an interrupted comparison can be resumed.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "comparisons/results/records.h"
#include "problem/files/checked_file.h"

namespace springproof {

/// `stamp` identifies the inputs of the part; a part is only loaded with the same stamp.
void save_part(const std::filesystem::path& file, const std::string& stamp, const Part& part);

/// Nothing if there is no such file or its stamp differs.
/// @throws DamagedFile
std::optional<Part> load_part(const std::filesystem::path& file, const std::string& stamp);

}  // namespace springproof
