#include "meshes/field.h"

#include <sstream>
#include <stdexcept>

#include "meshes/volume.h"
#include "problem/files/encoding.h"
#include "problem/files/files.h"

namespace springproof {
namespace {

constexpr std::uint8_t vtk_line = 3, vtk_tetrahedron = 10, vtk_hexahedron = 12;

template <class Rows>
VtuArray nodal_values(const std::string& name, const Rows& values) {
  return {name, static_cast<int>(values.cols()), {values.data(), values.data() + values.size()}};
}

void add_cell_data(const NamedNumbers& values, VtuFile& vtu) {
  for (const auto& [name, numbers] : values) {
    if (numbers.size() != vtu.types.size()) throw std::invalid_argument("'" + name + "': one number per cell");
    vtu.cell_data.push_back({name, 1, numbers});
  }
}

VtuFile vtu_of(const Field& field, const NodalFields& extra) {
  const Mesh& mesh = *field.mesh;
  const Eigen::VectorXd rest = cell_volumes(mesh, mesh.nodes);
  const Eigen::VectorXd change = (cell_volumes(mesh, mesh.nodes + field.displacement) - rest).cwiseQuotient(rest);
  VtuFile vtu{mesh.nodes, {}, {}, {}, {}, {}, {}};
  for (const Hexahedron& cell : mesh.hexahedra) vtu.add_cell(cell, vtk_hexahedron);
  for (const Tetrahedron& cell : mesh.tetrahedra) vtu.add_cell(cell, vtk_tetrahedron);
  vtu.point_data.push_back(nodal_values("displacement", field.displacement));
  for (const auto& [name, values] : extra) vtu.point_data.push_back(nodal_values(name, values));
  vtu.cell_data.push_back({"relative_volume_change", 1, {change.begin(), change.end()}});
  return vtu;
}

}  // namespace

void write_vtu(const std::filesystem::path& file, const Field& field, const NodalFields& extra, const VtuNotes& notes,
               const NamedNumbers& of_cells) {
  const Eigen::Index nodes = field.mesh->nodes.rows();
  if (field.displacement.rows() != nodes) throw std::invalid_argument("write_vtu: one displacement per node");
  for (const auto& [name, values] : extra)
    if (values.rows() != nodes) throw std::invalid_argument("write_vtu: '" + name + "': one row per node");

  VtuFile vtu = vtu_of(field, extra);
  add_cell_data(of_cells, vtu);
  vtu.notes = notes;
  write_file(file, text_of(vtu));
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

void write_lines_vtu(const std::filesystem::path& file, const NodalVectors& points, const NodalVectors& displacement,
                     const std::vector<std::array<int, 2>>& lines, const NamedNumbers& values) {
  if (displacement.rows() != points.rows()) throw std::invalid_argument("write_lines_vtu: one displacement per point");
  VtuFile vtu{points, {}, {}, {}, {nodal_values("displacement", displacement)}, {}, {}};
  for (const std::array<int, 2>& line : lines) vtu.add_cell(line, vtk_line);
  add_cell_data(values, vtu);
  write_file(file, text_of(vtu));
}

}  // namespace springproof
