#include "meshes/vtu.h"

#include <zlib.h>

#include <bit>
#include <new>
#include <sstream>

#include "problem/files/encoding.h"

namespace springproof {
namespace {

static_assert(std::endian::native == std::endian::little, "the VTU header says LittleEndian");

/// As VTK's vtkZLibDataCompressor wants inline binary: number of blocks, size of a block, of a last and shorter one
/// (none), of each compressed; then the blocks.  All bytes are one block.
template <class T>
std::string encoded(const T* data, std::size_t count) {
  const std::uint64_t size = count * sizeof(T);
  uLongf packed_size = compressBound(size);
  std::vector<unsigned char> packed(packed_size);
  if (size > 0 &&
      compress2(packed.data(), &packed_size, reinterpret_cast<const Bytef*>(data), size, Z_BEST_SPEED) != Z_OK)
    throw std::bad_alloc();
  const std::uint64_t header[] = {size > 0 ? 1u : 0u, size, 0, packed_size};
  const std::size_t header_size = sizeof header - (size > 0 ? 0 : sizeof *header);
  return base64(header, header_size) + base64(packed.data(), size > 0 ? packed_size : 0);
}

template <class T>
void write_array(std::ostream& out, const std::string& name, const char* type, int components, const T* data,
                 std::size_t count) {
  out << "        <DataArray type=\"" << type << "\" Name=\"" << name << "\" NumberOfComponents=\"" << components
      << "\" format=\"binary\">" << encoded(data, count) << "</DataArray>\n";
}

void write_reals(std::ostream& out, const std::string& name, int components, const double* data, std::size_t count,
                 bool single) {
  if (single) {
    const std::vector<float> rounded(data, data + count);
    write_array(out, name, "Float32", components, rounded.data(), count);
  } else {
    write_array(out, name, "Float64", components, data, count);
  }
}

/// Texts as VTK stores strings: the codes of their bytes, then 0.
void write_notes(std::ostream& out, const VtuNotes& notes) {
  if (notes.texts.empty() && notes.numbers.empty()) return;
  out << "    <FieldData>\n";
  for (const auto& [name, text] : notes.texts) {
    out << "      <DataArray type=\"String\" Name=\"" << xml_escaped(name)
        << "\" NumberOfTuples=\"1\" format=\"ascii\">";
    for (const unsigned char c : text) out << int(c) << ' ';
    out << "0</DataArray>\n";
  }
  for (const auto& [name, number] : notes.numbers)
    out << "      <DataArray type=\"Float64\" Name=\"" << xml_escaped(name)
        << "\" NumberOfTuples=\"1\" format=\"binary\">" << encoded(&number, 1) << "</DataArray>\n";
  out << "    </FieldData>\n";
}

/// The first array of the list is the one that is shown first.
void write_data(std::ostream& out, const char* element, const char* shown, const std::vector<VtuArray>& arrays,
                bool single) {
  out << "      <" << element;
  if (!arrays.empty()) out << " " << shown << "=\"" << xml_escaped(arrays.front().name) << "\"";
  out << ">\n";
  for (const VtuArray& a : arrays)
    write_reals(out, xml_escaped(a.name), a.components, a.values.data(), a.values.size(), single);
  out << "      </" << element << ">\n";
}

}  // namespace

std::string text_of(const VtuFile& vtu) {
  std::ostringstream out;
  out << "<?xml version=\"1.0\"?>\n"
         "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
         "header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n"
         "  <UnstructuredGrid>\n";
  write_notes(out, vtu.notes);
  const bool single = vtu.notes.single;
  out << "    <Piece NumberOfPoints=\"" << vtu.points.rows() << "\" NumberOfCells=\"" << vtu.types.size() << "\">\n";
  const bool vectors = !vtu.point_data.empty() && vtu.point_data.front().components == 3;
  write_data(out, "PointData", vectors ? "Vectors" : "Scalars", vtu.point_data, single);
  write_data(out, "CellData", "Scalars", vtu.cell_data, single);
  out << "      <Points>\n";
  write_reals(out, "position", 3, vtu.points.data(), static_cast<std::size_t>(vtu.points.size()), single);
  out << "      </Points>\n      <Cells>\n";
  write_array(out, "connectivity", "Int32", 1, vtu.connectivity.data(), vtu.connectivity.size());
  write_array(out, "offsets", "Int32", 1, vtu.offsets.data(), vtu.offsets.size());
  write_array(out, "types", "UInt8", 1, vtu.types.data(), vtu.types.size());
  out << "      </Cells>\n    </Piece>\n  </UnstructuredGrid>\n</VTKFile>\n";
  return std::move(out).str();
}

}  // namespace springproof
