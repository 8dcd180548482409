#include <fmt/format.h>
#include <zlib.h>

#include <bit>
#include <iterator>
#include <map>
#include <stdexcept>

#include "meshes/vtu.h"
#include "msm/exchange/springs_document.h"
#include "problem/files/files.h"
#include "problem/system/input_error.h"

namespace springproof {
namespace {

using Json = nlohmann::ordered_json;

void append(double value, std::string& out) {
  const std::size_t start = out.size();
  fmt::format_to(std::back_inserter(out), "{}", value);
  if (out.find_first_of(".e", start) == std::string::npos) out += ".0";  // readers tell it from an integer
}
void append(std::int32_t value, std::string& out) { fmt::format_to(std::back_inserter(out), "{}", value); }

/// In one line.
void append(const NamedArray& array, std::string& out) {
  const bool flat = array.shape.size() == 1;
  const std::size_t rows = array.shape[0], columns = flat ? 1 : array.shape[1];
  std::visit(
      [&](const auto& values) {
        out += '[';
        for (std::size_t r = 0; r < rows; ++r) {
          if (r > 0) out += ',';
          if (!flat) out += '[';
          for (std::size_t c = 0; c < columns; ++c) {
            if (c > 0) out += ',';
            append(values[r * columns + c], out);
          }
          if (!flat) out += ']';
        }
        out += ']';
      },
      array.values);
}

/// One key per line.
void append(const Json& value, const std::map<std::string, const NamedArray*>& arrays, int depth, std::string& out) {
  if (value.is_object() && !value.empty()) {
    const char* before = "{\n";
    for (const auto& [key, member] : value.items()) {
      out += before;
      out.append(depth + 1, ' ');
      out += Json(key).dump() + ": ";
      append(member, arrays, depth + 1, out);
      before = ",\n";
    }
    out += '\n';
    out.append(depth, ' ');
    out += '}';
    return;
  }
  const auto array = value.is_string() ? arrays.find(value.get_ref<const std::string&>()) : arrays.end();
  array != arrays.end() ? append(*array->second, out) : void(out += value.dump());
}

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

/// A zip file of the named contents, not compressed.
/// @throws std::invalid_argument beyond 4 GB, or 65,535 files.
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

/// NumPy's archive of arrays: a zip file of .npy files.
std::string springs_as_npz(const SpringsFile& springs) {
  const SpringsDocument document = document_of(springs);
  std::vector<std::pair<std::string, std::string>> files = {{"springs.json", document.head.dump(1)}};
  for (const NamedArray& array : document.arrays) files.emplace_back(array.name + ".npy", npy(array));
  return zip(files);
}

std::string springs_as_vtu(const SpringsFile& springs) {
  constexpr std::uint8_t line = 3, hexahedron = 12;
  const Network& network = springs.model.network;
  VtuFile vtu{network.X, {}, {}, {}, {}, {}};
  VtuArray stiffness{"stiffness_N_m", 1, {}}, rest_length{"rest_length_m", 1, {}};
  for (const Spring& s : network.springs) {
    vtu.add_cell(std::array{s.i, s.j}, line);
    stiffness.values.push_back(s.stiffness);
    rest_length.values.push_back(s.rest_length);
  }
  const Eigen::VectorXd mass = masses(network, springs.density);
  vtu.point_data = {{"mass_kg", 1, {mass.begin(), mass.end()}}};
  vtu.cell_data = {std::move(stiffness), std::move(rest_length)};
  if (!network.springs.empty()) return text_of(vtu);
  VtuArray fraction{"fraction", 1, {}}, material{"material", 1, {}};
  for (std::size_t c = 0; c < network.cells.size(); ++c) {
    vtu.add_cell(network.cells.corners[c], hexahedron);
    fraction.values.push_back(network.cells.part(c).fraction);
    material.values.push_back(network.cells.material(c));
  }
  vtu.cell_data = {std::move(fraction), std::move(material)};
  return text_of(vtu);
}

struct SpringsForm {
  const char* ending;
  std::string (*write)(const SpringsFile&);
};
constexpr SpringsForm springs_forms[] = {
    {".json", springs_as_json}, {".npz", springs_as_npz}, {".vtu", springs_as_vtu}};

const SpringsForm& form_of(const std::filesystem::path& file) {
  for (const SpringsForm& form : springs_forms)
    if (file.extension() == form.ending) return form;
  throw InputError(fmt::format("{}: is no name of a springs file (allowed: a name that ends in .json, .npz or .vtu)",
                               file.string()));
}

}  // namespace

std::string as_json(const SpringsDocument& document) {
  std::map<std::string, const NamedArray*> arrays;
  for (const NamedArray& array : document.arrays) arrays["npy:" + array.name] = &array;
  std::string out;
  append(document.head, arrays, 0, out);
  return out + "\n";
}

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

std::string springs_as_json(const SpringsFile& springs) { return as_json(document_of(springs)); }

void require_springs_ending(const std::filesystem::path& file) { form_of(file); }

void write_springs(const std::filesystem::path& file, const SpringsFile& springs) {
  write_named_file(file, form_of(file).write(springs));
}

}  // namespace springproof
