#include "comparisons/prepare/input_checksum.h"

#include "meshes/mesher/mesh_cache.h"
#include "meshes/mesher/mesher.h"
#include "problem/files/checksum.h"
#include "problem/files/files.h"

namespace springproof {

std::string input_checksum(const Experiment& e) {
  std::string all = checksum(e.text);
  const auto add = [&](const std::filesystem::path& file) {
    all += file.filename().string() + checksum(text_of_file(file));
  };
  for (const auto& file : files_behind(find_geo(e.body, e.file))) add(file);
  for (const MaterialRegion& region : e.regions)
    if (const auto* in = std::get_if<EnclosedPlace>(&region.place)) add(in->file);
  for (const std::filesystem::path& history : e.histories) add(history);
  for (const ModelChoice& model : e.models)
    if (!model.file.empty()) add(model.file);
  return checksum(all);
}

}  // namespace springproof
