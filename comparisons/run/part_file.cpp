#include "comparisons/run/part_file.h"

#include <string_view>

#include "comparisons/results/records_json.h"

namespace springproof {

// File format: this heading (comparisons/run/checked_file.h), then the stamp and the part.
static constexpr std::string_view heading = "springproof part 3 ";

void save_part(const std::filesystem::path& file, const std::string& stamp, const Part& part) {
  write_checked(file, heading, {{"stamp", stamp}, {"part", part}});
}

std::optional<Part> load_part(const std::filesystem::path& file, const std::string& stamp) try {
  if (!std::filesystem::exists(file)) return {};
  const nlohmann::json document = read_checked(file, heading);
  if (document.at("stamp") != stamp) return {};
  return document.at("part").get<Part>();
} catch (const nlohmann::json::exception&) {
  refuse_damaged(file);
}

}  // namespace springproof
