// A finished part on disk, so that an interrupted comparison can go on.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "comparisons/case_run.h"

namespace springproof {

/// `stamp` says what the part was computed from; a part is only taken back with the same stamp.
void save_part(const std::filesystem::path& file, const std::string& stamp, const Part& part);

/// Nothing if there is no such file, it cannot be read, or its stamp differs.
std::optional<Part> load_part(const std::filesystem::path& file, const std::string& stamp);

}  // namespace springproof
