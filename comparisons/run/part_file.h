// Serialises finished parts to disk, so that an interrupted comparison can be resumed.
#pragma once

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>

#include "comparisons/report/results.h"

namespace springproof {

/// `stamp` identifies the inputs of the part; a part is only loaded with the same stamp.
void save_part(const std::filesystem::path& file, const std::string& stamp, const Part& part);

/// Thrown if a part's file is damaged.
class DamagedPart : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Nothing if there is no such file or its stamp differs.
/// @throws DamagedPart
std::optional<Part> load_part(const std::filesystem::path& file, const std::string& stamp);

}  // namespace springproof
