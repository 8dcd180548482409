#include "msm/exchange/npz.h"

#include <fmt/format.h>
#include <zlib.h>

#include <bit>
#include <stdexcept>

namespace springproof {
namespace {

static_assert(std::endian::native == std::endian::little, "the headers say little-endian");

/// Little-endian numbers of a zip file.
void put(std::string& out, int bytes, std::uint64_t value) {
  for (int b = 0; b < bytes; ++b) out += static_cast<char>(value >> (8 * b));
}

/// The fields that a file's local header and its entry of the directory share.
void put_common(std::string& out, const std::string& name, const std::string& content, std::uint32_t checksum) {
  constexpr std::uint64_t version = 20, stored = 0, midnight = 0, first_of_1980 = 0x21, utf8_names = 0x800;
  put(out, 2, version);
  put(out, 2, utf8_names);
  put(out, 2, stored);
  put(out, 2, midnight);
  put(out, 2, first_of_1980);
  put(out, 4, checksum);
  put(out, 4, content.size());
  put(out, 4, content.size());
  put(out, 2, name.size());
  put(out, 2, 0);  // extra field
}

}  // namespace

std::string npy(const NamedArray& array) {
  std::string header = fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}{}), }}",
                                   array.values.index() == 0 ? "<f8" : "<i4", fmt::join(array.shape, ", "),
                                   array.shape.size() == 1 ? "," : "");
  constexpr std::size_t before = 10, alignment = 64;
  while ((before + header.size() + 1) % alignment != 0) header += ' ';
  header += '\n';
  std::string out = "\x93NUMPY\x01";
  out += '\0';
  put(out, 2, header.size());
  out += header;
  std::visit(
      [&](const auto& values) {
        out.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(values[0]));
      },
      array.values);
  return out;
}

std::string zip(const std::vector<std::pair<std::string, std::string>>& files) {
  std::string out, directory;
  for (const auto& [name, content] : files) {
    const std::uint64_t start = out.size();
    const auto checksum =
        static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(content.data()), content.size()));
    out += "PK\x03\x04";
    put_common(out, name, content, checksum);
    out += name;
    out += content;
    directory += "PK\x01\x02";
    put(directory, 2, 20);  // made by version
    put_common(directory, name, content, checksum);
    put(directory, 2, 0);  // comment
    put(directory, 2, 0);  // disk
    put(directory, 2, 0);  // internal attributes
    put(directory, 4, 0);  // external attributes
    put(directory, 4, start);
    directory += name;
    if (out.size() > 0xffffffffu || files.size() > 0xffff)
      throw std::invalid_argument("an .npz file of more than 4 GB (write .json instead)");
  }
  const std::uint64_t at = out.size();
  out += directory;
  out += "PK\x05\x06";
  put(out, 4, 0);  // disks
  put(out, 2, files.size());
  put(out, 2, files.size());
  put(out, 4, directory.size());
  put(out, 4, at);
  put(out, 2, 0);  // comment
  return out;
}

}  // namespace springproof
