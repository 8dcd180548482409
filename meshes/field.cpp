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

constexpr int vtk_tetrahedron = 10, vtk_hexahedron = 12;

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

void write_cells(std::ostream& out, const Mesh& mesh) {
  std::vector<std::int32_t> connectivity, offsets;
  std::vector<std::uint8_t> types;
  auto add = [&](const auto& cell, int type) {
    connectivity.insert(connectivity.end(), cell.begin(), cell.end());
    offsets.push_back(static_cast<std::int32_t>(connectivity.size()));
    types.push_back(static_cast<std::uint8_t>(type));
  };
  for (const Hexahedron& cell : mesh.hexahedra) add(cell, vtk_hexahedron);
  for (const Tetrahedron& cell : mesh.tetrahedra) add(cell, vtk_tetrahedron);
  out << "      <Cells>\n";
  write_integers(out, "connectivity", "Int32", connectivity);
  write_integers(out, "offsets", "Int32", offsets);
  write_integers(out, "types", "UInt8", types);
  out << "      </Cells>\n";
}

void write_document(std::ostream& out, const Field& field,
                    const std::vector<std::pair<std::string, NodalVectors>>& extra) {
  const Mesh& mesh = *field.mesh;
  const Eigen::VectorXd rest = cell_volumes(mesh, mesh.nodes);
  const Eigen::VectorXd change = (cell_volumes(mesh, mesh.nodes + field.displacement) - rest).cwiseQuotient(rest);
  out << "<?xml version=\"1.0\"?>\n"
         "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
         "header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n"
         "  <UnstructuredGrid>\n"
      << "    <Piece NumberOfPoints=\"" << mesh.nodes.rows() << "\" NumberOfCells=\"" << rest.size() << "\">\n"
      << "      <PointData Vectors=\"displacement\">\n";
  write_vectors(out, "displacement", field.displacement);
  for (const auto& [name, values] : extra) write_vectors(out, xml_escaped(name), values);
  out << "      </PointData>\n      <CellData Scalars=\"relative_volume_change\">\n";
  write_array(out, "relative_volume_change", "Float64", 1, change.data(), static_cast<std::size_t>(change.size()));
  out << "      </CellData>\n      <Points>\n";
  write_vectors(out, "position", mesh.nodes);
  out << "      </Points>\n";
  write_cells(out, mesh);
  out << "    </Piece>\n  </UnstructuredGrid>\n</VTKFile>\n";
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

void write_pvd(const std::filesystem::path& file, const std::vector<std::pair<double, std::string>>& series) {
  std::ostringstream out;
  out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n  "
         "<Collection>\n";
  for (const auto& [time, vtu] : series)
    out << "    <DataSet timestep=\"" << time << "\" file=\"" << xml_escaped(vtu) << "\"/>\n";
  out << "  </Collection>\n</VTKFile>\n";
  write_file(file, out.view());
}

}  // namespace springproof
