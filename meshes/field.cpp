#include "meshes/field.h"

#include <zlib.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <new>
#include <sstream>
#include <stdexcept>

#include "meshes/volume.h"
#include "problem/system/encoding.h"
#include "problem/system/files.h"

namespace springproof {
namespace {

static_assert(std::endian::native == std::endian::little, "the VTU header says LittleEndian");

constexpr int vtk_line = 3, vtk_tetrahedron = 10, vtk_hexahedron = 12;

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

void write_vectors(std::ostream& out, const std::string& name, const NodalVectors& values) {
  write_array(out, name, "Float64", 3, values.data(), static_cast<std::size_t>(values.size()));
}

template <class T>
void write_integers(std::ostream& out, const std::string& name, const char* type, const std::vector<T>& values) {
  write_array(out, name, type, 1, values.data(), values.size());
}

/// Cells of any VTK types.
struct CellArrays {
  std::vector<std::int32_t> connectivity, offsets;
  std::vector<std::uint8_t> types;

  template <class Cell>
  void add(const std::vector<Cell>& cells, int type) {
    for (const Cell& cell : cells) {
      connectivity.insert(connectivity.end(), cell.begin(), cell.end());
      offsets.push_back(static_cast<std::int32_t>(connectivity.size()));
      types.push_back(static_cast<std::uint8_t>(type));
    }
  }
};

CellArrays cells_of(const Mesh& mesh) {
  CellArrays cells;
  cells.add(mesh.hexahedra, vtk_hexahedron);
  cells.add(mesh.tetrahedra, vtk_tetrahedron);
  return cells;
}

void write_head(std::ostream& out, Eigen::Index points, std::size_t cells) {
  out << "<?xml version=\"1.0\"?>\n"
         "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
         "header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n"
         "  <UnstructuredGrid>\n"
      << "    <Piece NumberOfPoints=\"" << points << "\" NumberOfCells=\"" << cells << "\">\n"
      << "      <PointData Vectors=\"displacement\">\n";
}

/// Points and cells, to the end of the document.
void write_rest(std::ostream& out, const NodalVectors& points, const CellArrays& cells) {
  out << "      </CellData>\n      <Points>\n";
  write_vectors(out, "position", points);
  out << "      </Points>\n      <Cells>\n";
  write_integers(out, "connectivity", "Int32", cells.connectivity);
  write_integers(out, "offsets", "Int32", cells.offsets);
  write_integers(out, "types", "UInt8", cells.types);
  out << "      </Cells>\n    </Piece>\n  </UnstructuredGrid>\n</VTKFile>\n";
}

void write_document(std::ostream& out, const Field& field,
                    const std::vector<std::pair<std::string, NodalVectors>>& extra) {
  const Mesh& mesh = *field.mesh;
  const Eigen::VectorXd rest = cell_volumes(mesh, mesh.nodes);
  const Eigen::VectorXd change = (cell_volumes(mesh, mesh.nodes + field.displacement) - rest).cwiseQuotient(rest);
  write_head(out, mesh.nodes.rows(), static_cast<std::size_t>(rest.size()));
  write_vectors(out, "displacement", field.displacement);
  for (const auto& [name, values] : extra) write_vectors(out, xml_escaped(name), values);
  out << "      </PointData>\n      <CellData Scalars=\"relative_volume_change\">\n";
  write_array(out, "relative_volume_change", "Float64", 1, change.data(), static_cast<std::size_t>(change.size()));
  write_rest(out, mesh.nodes, cells_of(mesh));
}

}  // namespace

void write_vtu(const std::filesystem::path& file, const Field& field,
               const std::vector<std::pair<std::string, NodalVectors>>& extra) {
  const Eigen::Index nodes = field.mesh->nodes.rows();
  if (field.displacement.rows() != nodes) throw std::invalid_argument("write_vtu: one displacement per node");
  for (const auto& [name, values] : extra)
    if (values.rows() != nodes) throw std::invalid_argument("write_vtu: '" + name + "': one vector per node");

  std::ostringstream out;
  write_document(out, field, extra);
  write_file(file, out.view());
}

void write_lines_vtu(const std::filesystem::path& file, const NodalVectors& points, const NodalVectors& displacement,
                     const std::vector<std::array<int, 2>>& lines,
                     const std::vector<std::pair<std::string, std::vector<double>>>& values) {
  if (displacement.rows() != points.rows()) throw std::invalid_argument("write_lines_vtu: one displacement per point");
  CellArrays cells;
  cells.add(lines, vtk_line);
  std::ostringstream out;
  write_head(out, points.rows(), lines.size());
  write_vectors(out, "displacement", displacement);
  out << "      </PointData>\n      <CellData>\n";
  for (const auto& [name, numbers] : values) {
    if (numbers.size() != lines.size()) throw std::invalid_argument("write_lines_vtu: one number per line");
    write_array(out, xml_escaped(name), "Float64", 1, numbers.data(), numbers.size());
  }
  write_rest(out, points, cells);
  write_file(file, out.view());
}

}  // namespace springproof
