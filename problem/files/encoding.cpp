#include "problem/files/encoding.h"

#include <array>
#include <cstdint>

namespace springproof {
namespace {

constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

}  // namespace

std::string base64(const void* data, std::size_t count) {
  const auto* bytes = static_cast<const unsigned char*>(data);
  std::string text;
  text.reserve((count + 2) / 3 * 4);
  for (std::size_t i = 0; i < count; i += 3) {
    const std::size_t left = count - i;
    const std::uint32_t word = bytes[i] << 16 | (left > 1 ? bytes[i + 1] << 8 : 0) | (left > 2 ? bytes[i + 2] : 0);
    text += digits[word >> 18 & 63];
    text += digits[word >> 12 & 63];
    text += left > 1 ? digits[word >> 6 & 63] : '=';
    text += left > 2 ? digits[word & 63] : '=';
  }
  return text;
}

std::string from_base64(std::string_view text) {
  static const std::array<int, 256> values = [] {
    std::array<int, 256> v;
    v.fill(-1);
    for (std::size_t i = 0; i < digits.size(); ++i) v[static_cast<unsigned char>(digits[i])] = static_cast<int>(i);
    return v;
  }();
  std::string out;
  unsigned group = 0;
  int bits = 0;
  for (const unsigned char c : text) {
    if (values[c] < 0) break;
    group = (group << 6 | static_cast<unsigned>(values[c])) & 0xffffff;
    if ((bits += 6) < 8) continue;
    bits -= 8;
    out += static_cast<char>(group >> bits & 0xff);
  }
  return out;
}

std::string xml_escaped(std::string_view text) {
  constexpr std::string_view reserved = "&<>\"", names[] = {"&amp;", "&lt;", "&gt;", "&quot;"};
  std::string out;
  for (const char c : text) {
    const std::size_t at = reserved.find(c);
    at < reserved.size() ? out += names[at] : out += c;
  }
  return out;
}

}  // namespace springproof
