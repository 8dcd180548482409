#include "problem/files/checked_file.h"

#include <fmt/format.h>

#include "problem/files/checksum.h"
#include "problem/files/named_files.h"
#include "problem/files/new_file.h"
#include "problem/system/input_error.h"

namespace springproof {
namespace {

NewFile checked(const std::filesystem::path& file, std::string_view heading, std::string_view content) {
  return NewFile(file, {heading, checksum(content), "\n", content});
}

}  // namespace

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
