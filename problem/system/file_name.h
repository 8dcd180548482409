// Names that a user gives as names of files.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>

namespace springproof {

/// The name with "_" for what has a meaning in paths or none to see: no name leads out of a folder or is hidden in it.
inline std::string file_name(std::string name) {
  const auto special = [](char c) {
    return static_cast<unsigned char>(c) <= ' ' || c == 0x7f ||
           std::string_view("/\\:*?\"<>|").find(c) != std::string::npos;
  };
  std::replace_if(name.begin(), name.end(), special, '_');
  if (name.starts_with('.')) name.front() = '_';
  return name;
}

/// The same for names that a file system may take for the same: file_name in lower case.
inline std::string file_name_key(const std::string& name) {
  std::string key = file_name(name);
  std::transform(key.begin(), key.end(), key.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return key;
}

inline constexpr std::size_t longest_file_name = 120;  ///< bytes, which leaves room for what is put behind

}  // namespace springproof
