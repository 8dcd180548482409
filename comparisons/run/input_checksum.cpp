#include "comparisons/run/input_checksum.h"

#include "comparisons/run/checksum.h"
#include "meshes/mesher/script_files.h"
#include "problem/system/files.h"

namespace springproof {

std::string input_checksum(const PreparedCase& p) {
  std::string all = checksum(p.experiment.text);
  const auto add = [&](const std::filesystem::path& file) {
    all += file.filename().string() + checksum(text_of_file(file));
  };
  for (const auto& file : files_behind(p.geo)) add(file);
  for (const ModelChoice& model : p.experiment.models)
    if (!model.file.empty()) add(model.file);
  return checksum(all);
}

}  // namespace springproof
