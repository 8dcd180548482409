#include "meshes/mesher/mesh_cache.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <cstdlib>
#include <string_view>
#include <vector>

#include "meshes/mesher/mesher_exchange.h"
#include "problem/processes/child.h"

namespace springproof {
namespace {

namespace fs = std::filesystem;

// File format: this heading (problem/files/new_file.h), then the key and the answer of the mesher.
const KeptKind kept_mesh = {"mesh", ".cbor", "springproof mesh 1 "};

constexpr std::size_t longest_name = 4096;

/// What stands between two of these marks on one line.
void add_strings(std::string_view text, char mark, std::vector<std::string>& strings) {
  for (std::size_t begin = text.find(mark); begin != std::string_view::npos; begin = text.find(mark, begin + 1)) {
    const std::size_t end = text.find_first_of(std::string{mark, '\n'}, begin + 1);
    if (end == std::string_view::npos || text[end] == '\n' || end - begin > longest_name) continue;
    strings.emplace_back(text.substr(begin + 1, end - begin - 1));
  }
}

/// Files in the folder whose names begin so.
void add_beginning_with(const fs::path& folder, const std::string& beginning, std::vector<fs::path>& files) {
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (entry->path().filename().string().starts_with(beginning)) files.push_back(entry->path());
}

/// Files that the text may mean, there or not.
std::vector<fs::path> named_in(const std::string& text, const fs::path& folder) {
  std::vector<std::string> strings;
  for (const char mark : {'"', '\''}) add_strings(text, mark, strings);
  std::vector<fs::path> files;
  for (const std::string& name : strings) {
    const fs::path file = folder / name;
    const std::string last = file.filename().string();
    if (const auto percent = last.find('%'); percent != std::string::npos)
      add_beginning_with(file.parent_path(), last.substr(0, percent), files);
    else
      files.push_back(file);
  }
  return files;
}

void add(const fs::path& file, std::set<fs::path>& files) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return;
  const fs::path real = fs::canonical(file, error);
  if (error || !files.insert(real).second) return;
  for (const fs::path& other : named_in(text_of_file(real), file.parent_path())) add(other, files);
}

}  // namespace

std::set<fs::path> files_behind(const fs::path& body) {
  std::set<fs::path> files;
  add(body, files);
  fs::path options = body;
  add(options += ".opt", files);  // gmsh reads it with the body
  return files;
}

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
