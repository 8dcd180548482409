#include "meshes/mesher/mesh_cache.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <cstdlib>
#include <set>

#include "meshes/mesher/mesher_exchange.h"
#include "meshes/mesher/script_files.h"
#include "problem/processes/child.h"

namespace springproof {
namespace {

namespace fs = std::filesystem;

// File format: this heading (problem/files/new_file.h), then the key and the answer of the mesher.
const KeptKind kept_mesh = {"mesh", ".cbor", "springproof mesh 1 "};

}  // namespace

std::string line_of(const fs::path& file) {
  struct stat s {};
  stat(file.c_str(), &s);
  return fmt::format("{} {} {} {}.{:09}\n", fs::absolute(file).string(), s.st_ino, s.st_size, s.st_ctim.tv_sec,
                     s.st_ctim.tv_nsec);
}

fs::path kept_folder() {
  if (const char* given = std::getenv("SPRINGPROOF_MESH_CACHE")) return given;
  const fs::path caches = cache_folder();
  return caches.empty() ? caches : caches / "meshes";
}

MeshCache::MeshCache(const MeshRequest& request, const fs::path& program) {
  const fs::path meshes = kept_folder();
  const bool script = extension_of(request.file) == ".geo";
  if (meshes.empty() || (script && !is_built_in(request.file))) return;
  std::string key = to_cbor(request) + "\n" + line_of(program);
  for (const fs::path& file : script ? files_behind(request.file) : std::set{request.file}) key += line_of(file);
  file_ = KeptFile(meshes, kept_mesh, key);
}

std::optional<MeshedBody> MeshCache::find() const {
  return file_.find([](const std::string& answer) { return answer_from_cbor(answer); });
}

void MeshCache::keep(const std::string& answer) const { file_.keep(answer); }

}  // namespace springproof
