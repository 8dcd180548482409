#include "meshes/gmsh/bodies.h"

#include <fmt/format.h>
#include <gmsh.h>

#include <algorithm>
#include <cmath>

#include "meshes/gmsh/quality.h"
#include "meshes/gmsh/read_mesh.h"
#include "meshes/mesher_exchange.h"
#include "meshes/stl.h"
#include "meshes/surface_check.h"
#include "meshes/volume.h"

namespace springproof {
namespace {

namespace fs = std::filesystem;

constexpr int tetrahedron = 4, hexahedron = 5, hexahedron_27 = 12;
constexpr double sliver = 0.05;  ///< 3 r/R below which better tetrahedra are tried
constexpr std::size_t most_cells = 20'000'000;

/// The block of the wanted type.
const ElementBlock& only_block(const fs::path& file, const std::vector<ElementBlock>& blocks, int type,
                               const char* wanted) {
  for (const ElementBlock& b : blocks)
    if (b.type != type)
      refuse(file, fmt::format("the mesh has {} elements of type '{}' where {} are wanted (hexahedra need transfinite or "
                               "extruded volumes with Recombine, tetrahedra no Recombine)", b.count(), b.name, wanted));
  if (blocks.empty()) refuse(file, fmt::format("gmsh made no {} (is there a volume?)", wanted));
  return blocks[0];
}

void generate(const fs::path& file, const GmshSession& session) {
  gmsh::option::setNumber("Mesh.ElementOrder", 1);
  gmsh::model::mesh::generate(3);
  session.stop_on_error(file);
}

void scale(Mesh& mesh, double factor) {
  mesh.nodes *= factor;
  mesh.curved *= factor;
  if (!mesh.grid) return;
  mesh.grid->origin *= factor;
  mesh.grid->spacing *= factor;
}

/// A script cut along its own lines, as mesh_geo says.
Mesh mesh_structured(const MeshRequest& r, const GmshSession& session) {
  generate(r.file, session);
  if (r.kind.second_order) {
    gmsh::option::setNumber("Mesh.SecondOrderIncomplete", 0);
    gmsh::model::mesh::setOrder(2);
    session.stop_on_error(r.file);
  }
  const int type = r.kind.tetrahedra ? tetrahedron : r.kind.second_order ? hexahedron_27 : hexahedron;
  const auto blocks = volume_elements();
  return read_mesh(r.file, only_block(r.file, blocks, type, r.kind.tetrahedra ? "tetrahedra" : "hexahedra"));
}

std::vector<std::pair<std::string, double>> parameters_of(const MeshRequest& r) {
  std::vector<std::pair<std::string, double>> parameters = {{"tetrahedra", r.kind.tetrahedra || r.edge > 0}};
  const char* const sizes[] = {"size_x", "size_y", "size_z"};
  const char* const counts[] = {"nx", "ny", "nz"};
  for (int c = 0; c < 3; ++c) {
    const bool sized = !r.size.isZero();
    if (sized) parameters.emplace_back(sizes[c], r.size[c]);
    if (r.cells[c] > 0)
      parameters.emplace_back(counts[c], r.cells[c]);
    else if (sized && r.edge > 0)  // a structured script
      parameters.emplace_back(counts[c], std::max(1.0, std::round(r.size[c] * r.scale / r.edge)));
  }
  if (r.edge > 0) parameters.emplace_back("edge", r.edge / r.scale);
  return parameters;
}

}  // namespace

void refuse_too_many(const MeshRequest& r, double volume) {
  const double cells = volume / (std::pow(r.edge, 3) / (6 * std::sqrt(2)));
  if (cells > most_cells)
    refuse(r.file, fmt::format("edge: {:g} m means about {:.2g} tetrahedra (allowed: {:.2g})", r.edge, cells,
                               double(most_cells)));
}

void want_edge(double edge) {
  gmsh::option::setNumber("Mesh.MeshSizeMin", edge);
  gmsh::option::setNumber("Mesh.MeshSizeMax", edge);
}

Mesh fill_with_tetrahedra(const fs::path& file, const GmshSession& session) {
  generate(file, session);
  const auto read = [&] {
    const auto blocks = volume_elements();
    return read_mesh(file, only_block(file, blocks, tetrahedron, "tetrahedra"));
  };
  const Mesh mesh = read();
  if (quality_of(mesh).worst > sliver) return mesh;
  gmsh::model::mesh::optimize("", true, 3);
  gmsh::model::mesh::optimize("Relocate3D", true);
  session.stop_on_error(file);
  return read();
}

MeshedBody mesh_script(const MeshRequest& r) {
  GmshSession session(parameters_of(r));
  if (r.edge > 0) {
    if (!r.size.isZero()) refuse_too_many(r, r.size.prod() * std::pow(r.scale, 3));
    gmsh::option::setNumber("Mesh.MeshSizeMax", r.edge / r.scale);  // unless the script says otherwise
  }
  gmsh::open(r.file.string());
  session.stop_on_error(r.file);
  if (r.edge > 0) return {fill_with_tetrahedra(r.file, session), {}, 0};
  return {mesh_structured(r, session), {}, 0};
}

MeshedBody mesh_solid(const MeshRequest& r) {
  GmshSession session({});
  gmsh::option::setString("Geometry.OCCTargetUnit", "M");
  gmsh::vectorpair shapes;
  gmsh::model::occ::importShapes(r.file.string(), shapes);
  session.stop_on_error(r.file);
  gmsh::model::occ::synchronize();
  gmsh::vectorpair volumes, surfaces;
  gmsh::model::getEntities(volumes, 3);
  if (volumes.empty()) refuse(r.file, "no solid in it (allowed: one solid; make one of its surfaces in a CAD program)");
  double volume = 0;
  for (const auto& [dimension, tag] : volumes) {
    double v;
    gmsh::model::occ::getMass(dimension, tag, v);
    volume += std::abs(v);
  }
  refuse_too_many(r, volume * std::pow(r.scale, 3));
  gmsh::model::getBoundary(volumes, surfaces, true, false, false);
  int number = 0;
  for (const auto& [dimension, tag] : surfaces) {
    const int group = gmsh::model::addPhysicalGroup(2, {tag});
    gmsh::model::setPhysicalName(2, group, fmt::format("surface_{}", ++number));
  }
  want_edge(r.edge / r.scale);
  return {fill_with_tetrahedra(r.file, session), {}, 0};
}

namespace {

/// Edge with which a body has about so many tetrahedra; gmsh's fill as much as regular ones of 0.95 of the edge.
double edge_for(int tetrahedra, double volume) {
  return std::cbrt(6 * std::sqrt(2) * volume / tetrahedra) / 0.95;
}

/// Edge for a first mesh, from which the volume is known.
double first_edge(const MeshRequest& r) {
  const std::string extension = extension_of(r.file);
  if (extension == ".geo") {
    if (r.size.isZero()) refuse(r.file, "size: needed to choose the length of the tetrahedra's edges");
    return std::cbrt(r.size.prod() / 4000);
  }
  GmshSession session({});
  if (extension == ".step" || extension == ".stp" || extension == ".brep") gmsh::option::setString("Geometry.OCCTargetUnit", "M");
  gmsh::open(r.file.string());
  session.stop_on_error(r.file);
  double low[3], high[3];
  gmsh::model::getBoundingBox(-1, -1, low[0], low[1], low[2], high[0], high[1], high[2]);
  return r.scale * std::cbrt((high[0] - low[0]) * (high[1] - low[1]) * (high[2] - low[2]) / 4000);
}

double chosen_edge(MeshRequest r) {
  if (extension_of(r.file) == ".stl") return edge_for(r.tetrahedra, std::pow(r.scale, 3) * volume(check_surface(read_stl(r.file), r.file.string()).surface));
  const int wanted = r.tetrahedra;
  r.tetrahedra = 0;
  r.edge = first_edge(r);
  const Mesh mesh = mesh_file(r).mesh;
  return edge_for(wanted, volume(mesh, mesh.nodes));
}

}  // namespace

MeshedBody mesh_file(const MeshRequest& request) try {
  MeshRequest r = request;
  if (r.tetrahedra > 0 && r.edge == 0) r.edge = chosen_edge(r);
  const std::string extension = extension_of(r.file);
  MeshedBody body = extension == ".geo"   ? mesh_script(r)
                    : extension == ".msh" ? mesh_msh(r)
                    : extension == ".stl" ? mesh_stl(r)
                                          : mesh_solid(r);
  if (r.scale != 1) scale(body.mesh, r.scale);
  body.edge = r.edge;
  if (r.edge > 0 && !body.mesh.tetrahedra.empty()) body.notes.push_back(words_for(body.mesh, quality_of(body.mesh)));
  return body;
} catch (const std::string& message) {
  refuse(request.file, "gmsh: " + message);
}

}  // namespace springproof
