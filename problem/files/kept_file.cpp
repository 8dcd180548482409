#include "problem/files/kept_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <regex>
#include <system_error>
#include <vector>

#include "problem/files/files.h"
#include "problem/files/new_file.h"
#include "problem/system/streams.h"

namespace springproof {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t most_bytes = 1'000'000'000;

/// Whether the name is of the kind: NAME-<checksum>ENDING, and before it has its place (problem/files/new_file.h) with
/// .<8 digits>.part.
bool has_name_of(const KeptKind& kind, const fs::path& file) {
  const std::regex ours(kind.name + "-[0-9a-f]{32}\\" + kind.ending + "(\\.[0-9a-f]{8}\\.part)?");
  return std::regex_match(file.filename().string(), ours);
}

bool begins_with(const std::string& heading, const fs::path& file) {
  std::string bytes(heading.size(), '\0');
  std::ifstream(file, std::ios::binary).read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return bytes == heading;
}

void remove_oldest(const fs::path& folder, const KeptKind& kind) {
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
    if (!has_name_of(kind, at->path()) || !fs::is_regular_file(at->symlink_status(gone)) ||
        !begins_with(kind.heading, at->path()))
      continue;
    Entry e{at->last_write_time(gone), at->file_size(gone), at->path()};
    if (gone) continue;
    all += e.bytes;
    entries.push_back(std::move(e));
  }
  std::ranges::sort(entries, [](const Entry& a, const Entry& b) { return a.used < b.used; });
  for (const Entry& e : entries) {
    if (all <= most_bytes) return;
    if (fs::remove(e.file, error)) all -= e.bytes;
  }
}

}  // namespace

KeptFile::KeptFile(const fs::path& folder, KeptKind kind, std::string key)
    : kind_(std::move(kind)), key_(std::move(key)) {
  if (!folder.empty()) file_ = folder / fmt::format("{}-{}{}", kind_.name, checksum(key_), kind_.ending);
}

std::optional<std::string> KeptFile::content() const {
  std::error_code error;
  if (file_.empty() || !fs::exists(file_, error)) return {};
  std::string content = read_checked(file_, kind_.heading);
  if (!content.starts_with(key_)) refuse_damaged(file_);
  fs::last_write_time(file_, fs::file_time_type::clock::now(), error);  // when it was used
  return content.substr(key_.size());
}

void KeptFile::say_damaged() const {
  to_stderr("note: the kept {} {} is damaged; it is made anew\n", kind_.name, file_.string());
}

void KeptFile::keep(const std::string& content) const {
  if (file_.empty()) return;
  std::error_code error;
  fs::create_directories(file_.parent_path(), error);
  try {
    write_checked(file_, kind_.heading, key_ + content);
  } catch (const std::system_error&) {
    return;
  }
  remove_oldest(file_.parent_path(), kind_);
}

}  // namespace springproof
