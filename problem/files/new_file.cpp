#include "problem/files/new_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <random>
#include <system_error>

#include "problem/files/files.h"
#include "problem/system/input_error.h"

namespace springproof {
namespace {

namespace fs = std::filesystem;

/// Each time another.
fs::path own_name(const fs::path& file) { return fmt::format("{}.{:08x}.part", file.string(), std::random_device()()); }

int create_alone(const fs::path& file) {
  return open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
}

bool write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno != EINTR) return false;
    bytes.remove_prefix(static_cast<std::size_t>(written < 0 ? 0 : written));
  }
  return true;
}

NewFile checked(const std::filesystem::path& file, std::string_view heading, std::string_view content) {
  return NewFile(file, {heading, checksum(content), "\n", content});
}

}  // namespace

NewFile::NewFile(const fs::path& file, std::initializer_list<std::string_view> pieces) : file_(file) {
  int descriptor = -1;
  do {
    const fs::path name = own_name(file);
    descriptor = create_alone(name);
    if (descriptor >= 0) own_ = name;
  } while (descriptor < 0 && errno == EEXIST);
  if (descriptor < 0) fail(errno);
  write(descriptor, pieces);
}

NewFile::~NewFile() {
  if (!own_.empty()) unlink(own_.c_str());
}

void NewFile::write(int descriptor, std::initializer_list<std::string_view> pieces) {
  int error = 0;
  for (const std::string_view bytes : pieces)
    if (error == 0 && !write_all(descriptor, bytes)) error = errno;
  if (close(descriptor) != 0 && error == 0) error = errno;  // of a network, or a quota
  if (error != 0) fail(error);
}

void NewFile::fail(int error) {
  if (!own_.empty()) unlink(own_.c_str());
  throw std::system_error(error, std::generic_category(), "cannot write " + file_.string());
}

void NewFile::replace() {
  if (rename(own_.c_str(), file_.c_str()) != 0) fail(errno);
  own_.clear();
}

// Not every file system has hard links (FAT has none), not every one renames only what is not there (NFS does not). One
// without both has the name taken by an empty file, for as long as a rename takes.
bool NewFile::create() {
  if (link(own_.c_str(), file_.c_str()) == 0) return true;
  if (errno == EEXIST) return false;
  if (renameat2(AT_FDCWD, own_.c_str(), AT_FDCWD, file_.c_str(), RENAME_NOREPLACE) == 0) {
    own_.clear();
    return true;
  }
  if (errno == EEXIST) return false;
  const int claim = create_alone(file_);
  if (claim < 0 && errno == EEXIST) return false;
  if (claim < 0) fail(errno);
  close(claim);
  replace();
  return true;
}

void write_checked(const std::filesystem::path& file, std::string_view heading, std::string_view content) {
  checked(file, heading, content).replace();
}

bool create_checked(const std::filesystem::path& file, std::string_view heading, std::string_view content) {
  return checked(file, heading, content).create();
}

std::string read_checked(const std::filesystem::path& file, std::string_view heading) try {
  std::string bytes = read_named_file(file, "");
  const std::size_t end = bytes.find('\n');
  if (end == std::string::npos || !bytes.starts_with(heading)) refuse_damaged(file);
  const std::string_view content = std::string_view(bytes).substr(end + 1);
  if (std::string_view(bytes).substr(heading.size(), end - heading.size()) != checksum(content)) refuse_damaged(file);
  return bytes.erase(0, end + 1);
} catch (const InputError&) {
  refuse_damaged(file);
}

void refuse_damaged(const std::filesystem::path& file) {
  throw DamagedFile(fmt::format("{} is damaged", file.string()));
}

}  // namespace springproof
