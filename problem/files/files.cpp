#include "problem/files/files.h"

#include <fmt/format.h>
#define XXH_INLINE_ALL  // the header alone: programs that link us need no library of it
#include <xxhash.h>

#include <cctype>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <limits>
#include <system_error>

#include "problem/files/new_file.h"
#include "problem/system/input_error.h"

namespace springproof {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& file, const std::string& why, std::string_view allowed) {
  throw InputError(SourceLocation{file.string(), 0, 0},
                   allowed.empty() ? why : fmt::format("{} (allowed: {})", why, allowed));
}

std::string too_large(std::uintmax_t limit) {
  constexpr std::uintmax_t MiB = std::uintmax_t{1} << 20, GiB = MiB << 10;
  return limit < GiB ? fmt::format("is larger than {} MiB", limit / MiB)
                     : fmt::format("is larger than {} GiB", limit / GiB);
}

/// Something is there, and a file in its place would be a loss: a pipe, a device.
bool takes_bytes_as_it_is(const fs::path& file) {
  std::error_code none;
  const fs::file_status status = fs::status(file, none);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

}  // namespace

std::string text_of_file(const std::filesystem::path& file) try {
  return read_named_file(file, "", std::numeric_limits<std::uintmax_t>::max());
} catch (const InputError&) {
  return {};
}

void write_file(const std::filesystem::path& file, std::string_view bytes) { NewFile(file, {bytes}).replace(); }

std::string checksum(std::string_view bytes) {
  const XXH128_hash_t hash = XXH3_128bits(bytes.data(), bytes.size());
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

std::string trimmed(std::string text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
  return text;
}

void require_file(const fs::path& file, std::string_view allowed, std::uintmax_t most_bytes) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (status.type() == fs::file_type::not_found) refuse(file, "no such file", allowed);
  if (!fs::status_known(status)) refuse(file, "cannot be read: " + error.message(), allowed);
  if (fs::is_directory(status)) refuse(file, "is a folder", allowed);
  if (!fs::is_regular_file(status)) refuse(file, "is no regular file", allowed);
  if (fs::file_size(file, error) > most_bytes && !error) refuse(file, too_large(most_bytes), allowed);
}

std::string read_named_file(const fs::path& file, std::string_view allowed, std::uintmax_t most_bytes) {
  require_file(file, allowed, most_bytes);
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  std::string bytes;
  for (char buffer[1 << 16]; in.read(buffer, sizeof buffer), in.gcount() > 0;) {
    bytes.append(buffer, static_cast<std::size_t>(in.gcount()));
    if (bytes.size() > most_bytes) refuse(file, too_large(most_bytes), allowed);  // files of /proc have no size
  }
  if (!in.eof()) refuse(file, fmt::format("cannot be read: {}", std::strerror(errno)), allowed);
  return bytes;
}

fs::path end_of_links(fs::path file) {
  constexpr int most_links = 40;  // as Linux
  for (int links = 0; links <= most_links; ++links) {
    std::error_code no_link;
    const fs::path to = fs::read_symlink(file, no_link);
    if (no_link) return file;
    file = file.parent_path() / to;
  }
  throw std::system_error(ELOOP, std::generic_category(), "cannot write " + file.string());
}

void write_named_file(const fs::path& file, std::string_view bytes) {
  if (!takes_bytes_as_it_is(file)) return write_file(end_of_links(file), bytes);
  std::ofstream out(file, std::ios::binary);
  out << bytes;
  out.close();
  if (!out) throw std::system_error(errno, std::generic_category(), "cannot write " + file.string());
}

}  // namespace springproof
