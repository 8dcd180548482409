#include "meshes/mesher/mesh_cache.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <regex>
#include <set>
#include <string_view>
#include <system_error>
#include <vector>

#include "meshes/mesher/mesher_exchange.h"
#include "meshes/mesher/script_files.h"
#include "problem/files/checked_file.h"
#include "problem/files/checksum.h"
#include "problem/processes/child.h"
#include "problem/system/streams.h"

namespace springproof {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t most_bytes = 1'000'000'000;

// File format: this heading (problem/files/checked_file.h), then the key and the answer of the mesher.
constexpr std::string_view heading = "springproof mesh 1 ";

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

/// Whether the name is one of ours: mesh-<checksum>.cbor, and before it has its place (problem/files/new_file.h) with
/// .<8 digits>.part.
bool has_our_name(const fs::path& file) {
  static const std::regex ours("mesh-[0-9a-f]{32}\\.cbor(\\.[0-9a-f]{8}\\.part)?");
  return std::regex_match(file.filename().string(), ours);
}

bool has_our_beginning(const fs::path& file) {
  std::string bytes(heading.size(), '\0');
  std::ifstream(file, std::ios::binary).read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return bytes == heading;
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
    if (!has_our_name(at->path()) || !fs::is_regular_file(at->symlink_status(gone)) || !has_our_beginning(at->path()))
      continue;
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
  file_ = meshes / fmt::format("mesh-{}.cbor", checksum(key_));
}

std::optional<MeshedBody> MeshCache::find() const {
  std::error_code error;
  if (key_.empty() || !fs::exists(file_, error)) return {};
  try {
    const std::string content = read_checked(file_, heading);
    if (!content.starts_with(key_)) refuse_damaged(file_);
    fs::last_write_time(file_, fs::file_time_type::clock::now(), error);  // when it was used
    return answer_from_cbor(content.substr(key_.size()));
  } catch (const std::runtime_error&) {
    to_stderr("note: the kept mesh {} is damaged; it is made anew\n", file_.string());
    return {};
  }
}

void MeshCache::keep(const std::string& answer) const {
  if (key_.empty()) return;
  std::error_code error;
  fs::create_directories(file_.parent_path(), error);
  try {
    write_checked(file_, heading, key_ + answer);
  } catch (const std::system_error&) {
    return;
  }
  remove_oldest(file_.parent_path());
}

}  // namespace springproof
