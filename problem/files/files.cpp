#include "problem/files/files.h"

#include <cctype>
#include <limits>

#include "problem/files/named_files.h"
#include "problem/files/new_file.h"
#include "problem/system/input_error.h"

namespace springproof {

std::string text_of_file(const std::filesystem::path& file) try {
  return read_named_file(file, "", std::numeric_limits<std::uintmax_t>::max());
} catch (const InputError&) {
  return {};
}

void write_file(const std::filesystem::path& file, std::string_view bytes) { NewFile(file, {bytes}).replace(); }

std::string trimmed(std::string text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
  return text;
}

}  // namespace springproof
