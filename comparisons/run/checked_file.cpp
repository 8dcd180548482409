#include "comparisons/run/checked_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <system_error>

#include "comparisons/run/checksum.h"
#include "problem/system/files.h"

namespace springproof {
namespace {

namespace fs = std::filesystem;

/// A name beside the file that no other process takes, on any machine.
fs::path own_name(const fs::path& file) {
  std::random_device random;
  return fmt::format("{}.{:08x}{:08x}.part", file.string(), random(), random());
}

/// The file under a name of this process alone, until it is put in its place.
class OwnFile {
 public:
  OwnFile(const fs::path& file, std::string_view heading, const nlohmann::json& content)
      : path(own_name(file)), file_(file) {
    std::string body;
    nlohmann::json::to_cbor(content, body);
    std::ofstream out(path, std::ios::binary);
    out << heading << checksum(body) << '\n' << body;
    out.close();
    if (!out) fail(errno);
  }
  ~OwnFile() { unlink(path.c_str()); }
  OwnFile(const OwnFile&) = delete;
  OwnFile& operator=(const OwnFile&) = delete;

  [[noreturn]] void fail(int error) const {
    unlink(path.c_str());
    throw std::runtime_error(
        fmt::format("cannot write {}: {}", file_.string(), std::generic_category().message(error)));
  }

  const fs::path path;

 private:
  const fs::path& file_;
};

}  // namespace

void write_checked(const fs::path& file, std::string_view heading, const nlohmann::json& content) {
  const OwnFile own(file, heading, content);
  if (rename(own.path.c_str(), file.c_str()) != 0) own.fail(errno);
}

bool create_checked(const fs::path& file, std::string_view heading, const nlohmann::json& content) {
  const OwnFile own(file, heading, content);
  if (link(own.path.c_str(), file.c_str()) == 0) return true;
  if (errno != EEXIST) own.fail(errno);
  return false;
}

nlohmann::json read_checked(const fs::path& file, std::string_view heading) try {
  const std::string bytes = text_of_file(file);
  const std::size_t end = bytes.find('\n');
  if (end == std::string::npos || !bytes.starts_with(heading)) refuse_damaged(file);
  const std::string_view body = std::string_view(bytes).substr(end + 1);
  if (std::string_view(bytes).substr(heading.size(), end - heading.size()) != checksum(body)) refuse_damaged(file);
  return nlohmann::json::from_cbor(body);
} catch (const nlohmann::json::exception&) {
  refuse_damaged(file);
}

void refuse_damaged(const fs::path& file) { throw DamagedFile(fmt::format("{} is damaged", file.string())); }

}  // namespace springproof
