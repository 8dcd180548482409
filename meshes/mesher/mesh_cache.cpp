#include "meshes/mesher/mesh_cache.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <set>
#include <vector>

#include "meshes/mesher/mesher_exchange.h"
#include "meshes/mesher/script_files.h"
#include "problem/system/child.h"

namespace springproof {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t most_bytes = 1'000'000'000;

/// Empty: none.
fs::path folder() {
  if (const char* given = std::getenv("SPRINGPROOF_MESH_CACHE")) return given;
  const fs::path caches = cache_folder();
  return caches.empty() ? caches : caches / "meshes";
}

/// Another file in its place, or another content, has another line.
std::string line_of(const fs::path& file) {
  struct stat s {};
  stat(file.c_str(), &s);
  return fmt::format("{} {} {} {}.{:09}\n", fs::absolute(file).string(), s.st_ino, s.st_size, s.st_ctim.tv_sec,
                     s.st_ctim.tv_nsec);
}

void remove_oldest(const fs::path& folder) {
  struct Entry {
    fs::file_time_type used;
    std::uintmax_t bytes;
    fs::path file;
  };
  std::vector<Entry> entries;
  std::uintmax_t all = 0;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    std::error_code gone;
    Entry e{at->last_write_time(gone), at->file_size(gone), at->path()};
    if (gone) continue;
    all += e.bytes;
    entries.push_back(std::move(e));
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.used < b.used; });
  for (const Entry& e : entries) {
    if (all <= most_bytes) return;
    if (fs::remove(e.file, error)) all -= e.bytes;
  }
}

}  // namespace

MeshCache::MeshCache(const MeshRequest& request, const fs::path& program) {
  const fs::path meshes = folder();
  const bool script = extension_of(request.file) == ".geo";
  if (meshes.empty() || (script && !is_built_in(request.file))) return;
  key_ = to_cbor(request) + "\n" + line_of(program);
  for (const fs::path& file : script ? files_behind(request.file) : std::set{request.file}) key_ += line_of(file);
  file_ = meshes / fmt::format("{:016x}.cbor", std::hash<std::string>()(key_));
}

std::optional<MeshedBody> MeshCache::find() const {
  if (key_.empty()) return {};
  const std::string bytes = text_of_file(file_);
  if (!bytes.starts_with(key_)) return {};
  std::error_code ignored;
  fs::last_write_time(file_, fs::file_time_type::clock::now(), ignored);  // when it was used
  try {
    return answer_from_cbor(bytes.substr(key_.size()));
  } catch (const std::runtime_error&) {  // damaged
    return {};
  }
}

void MeshCache::keep(const std::string& answer) const {
  if (key_.empty()) return;
  std::error_code error;
  fs::create_directories(file_.parent_path(), error);
  fs::path part = file_;
  part += fmt::format(".{}.part", gettid());
  std::ofstream out(part, std::ios::binary);
  out << key_ << answer;
  out.close();
  if (out) fs::rename(part, file_, error);
  if (!out || error) fs::remove(part, error);
  remove_oldest(file_.parent_path());
}

}  // namespace springproof
