// Reads the arrays of VTU files, as meshes/vtu.h writes them.
#pragma once

#include <zlib.h>

#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

namespace springproof::test {

inline std::vector<unsigned char> decode_base64(const std::string& text) {
  std::vector<unsigned char> bytes;
  std::uint32_t word = 0;
  int digits = 0, padding = 0;
  for (const char c : text) {
    int value = 0;
    if (c >= 'A' && c <= 'Z')
      value = c - 'A';
    else if (c >= 'a' && c <= 'z')
      value = c - 'a' + 26;
    else if (c >= '0' && c <= '9')
      value = c - '0' + 52;
    else if (c == '+')
      value = 62;
    else if (c == '/')
      value = 63;
    else if (c == '=')
      ++padding;
    else
      throw std::runtime_error("not base64");
    word = word << 6 | value;
    if (++digits % 4) continue;
    for (int shift = 16; shift >= 0; shift -= 8) bytes.push_back(word >> shift & 0xff);
    word = 0;
  }
  if (digits % 4) throw std::runtime_error("base64 is cut off");
  bytes.resize(bytes.size() - padding);
  return bytes;
}

/// The values of one DataArray: number of blocks, their size, 0, and the size of the first, compressed; then the block.
template <class T>
std::vector<T> read_array(const std::string& document, const std::string& name) {
  const std::size_t tag = document.find("Name=\"" + name + "\"");
  if (tag == std::string::npos) throw std::runtime_error("no array " + name);
  const std::size_t begin = document.find('>', tag) + 1, end = document.find('<', begin);
  const std::string text = document.substr(begin, end - begin);
  constexpr std::size_t header_digits = 44;  // of 32 bytes
  const auto head = decode_base64(text.substr(0, header_digits)), packed = decode_base64(text.substr(header_digits));
  std::uint64_t header[4];
  std::memcpy(header, head.data(), sizeof header);
  if (header[0] != 1 || header[2] != 0 || header[3] != packed.size()) throw std::runtime_error("wrong header");
  std::vector<T> values(header[1] / sizeof(T));
  uLongf size = header[1];
  if (uncompress(reinterpret_cast<Bytef*>(values.data()), &size, packed.data(), packed.size()) != Z_OK ||
      size != header[1])
    throw std::runtime_error("cannot be decompressed");
  return values;
}

}  // namespace springproof::test
