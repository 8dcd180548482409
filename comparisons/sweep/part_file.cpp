#include "comparisons/sweep/sweep.h"

#include <string_view>

#include "comparisons/results/records_json.h"

namespace springproof {

// File format: this heading (problem/files/new_file.h), then the stamp and the part.
static constexpr std::string_view part_heading = "springproof part 4 ";

void save_part(const std::filesystem::path& file, const std::string& stamp, const Part& part) {
  write_checked(file, part_heading, cbor({{"stamp", stamp}, {"part", part}}));
}

std::optional<Part> load_part(const std::filesystem::path& file, const std::string& stamp) try {
  if (!std::filesystem::exists(file)) return {};
  const nlohmann::json document = nlohmann::json::from_cbor(read_checked(file, part_heading));
  if (document.at("stamp") != stamp) return {};
  return document.at("part").get<Part>();
} catch (const nlohmann::json::exception&) {
  refuse_damaged(file);
}

}  // namespace springproof
