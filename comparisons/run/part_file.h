// A finished part on disk, so that an interrupted comparison can go on.
#pragma once

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>

#include "comparisons/report/results.h"

namespace springproof {

/// `stamp` says what the part was computed from; a part is only taken back with the same stamp.
void save_part(const std::filesystem::path& file, const std::string& stamp, const Part& part);

/// A part's file is not as it was written.
class DamagedPart : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Nothing if there is no such file or its stamp differs.
/// @throws DamagedPart
std::optional<Part> load_part(const std::filesystem::path& file, const std::string& stamp);

}  // namespace springproof
