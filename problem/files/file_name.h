// File names made from names that a user gives.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>

namespace springproof {

/// The name with "_" for characters special in paths, white space, control characters and a leading dot, so that no
/// file lies outside its folder or is hidden.
inline std::string file_name(std::string name) {
  const auto special = [](char c) {
    return static_cast<unsigned char>(c) <= ' ' || c == 0x7f ||
           std::string_view("/\\:*?\"<>|").find(c) != std::string::npos;
  };
  std::ranges::replace_if(name, special, '_');
  if (name.starts_with('.')) name.front() = '_';
  return name;
}

/// Equal for names that a case-insensitive file system does not distinguish: file_name in lower case.
inline std::string file_name_key(const std::string& name) {
  std::string key = file_name(name);
  std::transform(key.begin(), key.end(), key.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return key;
}

inline constexpr std::size_t longest_file_name = 120;  ///< bytes, which leaves room for suffixes

}  // namespace springproof
