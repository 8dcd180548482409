#include "problem/system/files.h"

#include <cerrno>
#include <fstream>
#include <system_error>

namespace springproof {

std::string text_of_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string text;
  for (char buffer[1 << 16]; in.read(buffer, sizeof buffer), in.gcount() > 0;) text.append(buffer, in.gcount());
  return text;
}

std::string trimmed(std::string text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
  return text;
}

namespace {

/// What a chain of symbolic links ends in, which may not exist yet.
std::filesystem::path end_of_links(std::filesystem::path file) {
  constexpr int most_links = 40;  // as Linux
  for (int links = 0; links <= most_links; ++links) {
    std::error_code no_link;
    const std::filesystem::path to = std::filesystem::read_symlink(file, no_link);
    if (no_link) return file;
    file = file.parent_path() / to;
  }
  throw std::system_error(ELOOP, std::generic_category(), "cannot write " + file.string());
}

}  // namespace

void write_file(const std::filesystem::path& name, std::string_view bytes) {
  const std::filesystem::path file = end_of_links(name);
  std::filesystem::path partial = file;
  partial += ".part";
  std::ofstream out(partial, std::ios::binary);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.close();
  std::error_code error;
  if (out) {
    std::filesystem::rename(partial, file, error);
    if (!error) return;
  }
  if (!error) error.assign(errno, std::generic_category());
  std::error_code ignored;
  std::filesystem::remove(partial, ignored);
  throw std::system_error(error, "cannot write " + file.string());
}

}  // namespace springproof
