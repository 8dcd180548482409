#include "meshes/gmsh/bodies.h"

#include <fmt/format.h>
#include <gmsh.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <string_view>

#include "meshes/gmsh/heights_above.h"
#include "meshes/gmsh/read_mesh.h"
#include "meshes/mesher/mesher_exchange.h"
#include "meshes/mesher/refined_meshes.h"
#include "meshes/quality.h"
#include "meshes/surface/balanced.h"
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
      refuse(file,
             fmt::format("the mesh has {} elements of type '{}' where {} are wanted (hexahedra need transfinite or "
                         "extruded volumes with Recombine, tetrahedra no Recombine)",
                         b.count(), b.name, wanted));
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
Mesh mesh_structured(const MeshRequest& r, const GmshSession& session, std::vector<std::string>& notes) {
  generate(r.file, session);
  if (r.kind.second_order) {
    gmsh::option::setNumber("Mesh.SecondOrderIncomplete", 0);
    gmsh::model::mesh::setOrder(2);
    session.stop_on_error(r.file);
  }
  const int type = r.kind.tetrahedra ? tetrahedron : r.kind.second_order ? hexahedron_27 : hexahedron;
  const auto blocks = volume_elements(r.file, r.volumes, notes);
  return read_mesh(r.file, only_block(r.file, blocks, type, r.kind.tetrahedra ? "tetrahedra" : "hexahedra"), notes);
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

double edge_for(int tetrahedra, double volume) { return 0.88 * edge_of_regular(volume, tetrahedra); }

void want_edge(double edge) {
  gmsh::option::setNumber("Mesh.MeshSizeMin", edge);
  gmsh::option::setNumber("Mesh.MeshSizeMax", edge);
}

Mesh fill_with_tetrahedra(const MeshRequest& r, const GmshSession& session, std::vector<std::string>& notes) {
  const fs::path& file = r.file;
  generate(file, session);
  const auto read = [&] {
    notes.clear();
    const auto blocks = volume_elements(file, r.volumes, notes);
    return read_mesh(file, only_block(file, blocks, tetrahedron, "tetrahedra"), notes);
  };
  const Mesh mesh = read();
  if (quality_of(mesh).worst > sliver) return mesh;
  gmsh::model::mesh::optimize("", true, 3);
  gmsh::model::mesh::optimize("Relocate3D", true);
  session.stop_on_error(file);
  return read();
}

namespace {

/// Of OpenCASCADE's volumes, in the file's units; 0: there are none.
double model_volume() {
  gmsh::vectorpair volumes;
  gmsh::model::occ::getEntities(volumes, 3);
  double sum = 0;
  for (const auto& [dimension, tag] : volumes) {
    double v = 0;
    gmsh::model::occ::getMass(dimension, tag, v);
    sum += std::abs(v);
  }
  return sum;
}

MeshedBody of_solid(MeshedBody body, double volume) {
  body.smooth_volume = volume;
  return body;
}

/// Moves the outer nodes so that the facets are balanced across the body's surface; back where a cell would lose most
/// of its volume.  A script is drawn into a box that lattices fill: nodes stay in it.
void balance(Mesh& mesh, bool in_box) {
  constexpr double least = 0.25;
  const Mesh before = mesh;
  const Surface outside = outside_of(mesh);
  const Surface moved = balanced(outside, heights_above(mesh, outside));
  for (Eigen::Index n = 0; n < mesh.nodes.rows(); ++n) mesh.nodes.row(n) = moved.points[n].transpose();
  if (in_box)
    for (int c = 0; c < 3; ++c)
      mesh.nodes.col(c) =
          mesh.nodes.col(c).cwiseMax(before.nodes.col(c).minCoeff()).cwiseMin(before.nodes.col(c).maxCoeff());
  const Eigen::VectorXd whole = cell_volumes(before, before.nodes);
  for (bool any = true; any;) {
    any = false;
    const Eigen::VectorXd now = cell_volumes(mesh, mesh.nodes);
    for (std::size_t c = 0; c < mesh.tetrahedra.size(); ++c)
      for (const int n : mesh.tetrahedra[c])
        if (now[static_cast<Eigen::Index>(c)] < least * whole[static_cast<Eigen::Index>(c)]) {
          any = any || mesh.nodes.row(n) != before.nodes.row(n);
          mesh.nodes.row(n) = before.nodes.row(n);
        }
  }
}

/// Tetrahedra of the opened model with facets that are balanced across its surfaces.
OneMesh balanced_mesh(const MeshRequest& r, const GmshSession& session, double edge) {
  OneMesh made{{}, {}, edge};
  made.mesh = fill_with_tetrahedra(r, session, made.notes);
  try {
    balance(made.mesh, extension_of(r.file) == ".geo");
    session.stop_on_error(r.file);
  } catch (const std::exception& e) {
    made.notes.push_back(fmt::format("facets are chords of curved surfaces: {}", e.what()));
  }
  return made;
}

void draw_with(double edge, double drawn) {
  gmsh::model::mesh::clear();
  gmsh::option::setNumber("Mesh.MeshSizeFactor", edge / drawn);
}

/// Meshes of one model as drawn with an edge of `drawn` [m]; all lengths scale together, those for round parts too.
MeshAt model_at(const MeshRequest& r, const GmshSession& session, double drawn) {
  return [&r, &session, drawn](double edge, double) {
    draw_with(edge, drawn);
    return balanced_mesh(r, session, edge);
  };
}

void open_script(const MeshRequest& r, const GmshSession& session) {
  gmsh::option::setNumber("Mesh.MeshSizeMax", r.edge / r.scale);  // unless the script says otherwise
  gmsh::open(r.file.string());
  session.stop_on_error(r.file);
}

/// A structured script, whose layers know nothing of factors.
MeshAt script_at(const MeshRequest& r) {
  return [&r](double edge, double) {
    MeshRequest own = r;
    own.edge = edge;
    GmshSession session(parameters_of(own));
    open_script(own, session);
    return balanced_mesh(r, session, edge);
  };
}

/// Whether some line of the model is cut into more pieces for shorter edges: quickly told, and then the cells follow
/// too.
bool lines_follow(double edge, double drawn) {
  const auto pieces = [&](double times) {
    gmsh::model::mesh::clear();
    gmsh::option::setNumber("Mesh.MeshSizeFactor", times * edge / drawn);
    gmsh::model::mesh::generate(1);
    std::vector<std::size_t> tags, nodes;
    gmsh::model::mesh::getElementsByType(1, tags, nodes);
    return tags.size();
  };
  return pieces(4) != pieces(1);
}

/// Whether the number of cells does not depend on the edge length.
bool is_structured(const MeshAt& at, double edge) try {
  const auto count = [&](double times) { return at(times * edge, times).mesh.tetrahedra.size(); };
  return count(4) == count(2) && count(2) == count(1);
} catch (const InputError&) {
  return false;
}

}  // namespace

MeshedBody mesh_script(const MeshRequest& request) {
  MeshRequest r = request;
  const bool by_edge = r.edge > 0 || r.tetrahedra > 0;
  if (!by_edge) {
    GmshSession session(parameters_of(r));
    gmsh::open(r.file.string());
    session.stop_on_error(r.file);
    MeshedBody body;
    body.mesh = mesh_structured(r, session, body.notes);
    return body;
  }
  const double box = r.size.prod() * std::pow(r.scale, 3);
  if (r.edge == 0 && box == 0) refuse(r.file, "size: needed to choose the length of the tetrahedra's edges");
  const double drawn = r.edge > 0 ? r.edge : edge_for(r.tetrahedra, 0.4 * box);
  r.edge = drawn;
  if (box > 0) refuse_too_many(r, box);
  double volume = 0;  // in the script's units
  {
    GmshSession session(parameters_of(r));
    open_script(r, session);
    volume = model_volume();
    if (request.edge == 0 && volume > 0) r.edge = edge_for(r.tetrahedra, std::pow(r.scale, 3) * volume);
    const MeshAt at = model_at(r, session, drawn);
    if (r.coarser.empty() || lines_follow(r.edge, drawn) || !is_structured(at, r.edge))
      return of_solid(mesh_refined(r, at), volume);
  }
  return of_solid(mesh_refined(r, script_at(r)), volume);
}

namespace {

/// Gives solids that touch the faces between them in common, and makes each a physical volume of its number in the file
/// and its label there.
void name_solids(const gmsh::vectorpair& solids) {
  std::vector<std::string> labels;
  for (const auto& [dimension, tag] : solids) {
    std::string label;
    gmsh::model::getEntityName(dimension, tag, label);
    labels.push_back(label.substr(label.rfind('/') + 1));
  }
  gmsh::vectorpair all;
  std::vector<gmsh::vectorpair> pieces = {solids};
  if (solids.size() > 1) {
    gmsh::model::occ::fragment({solids.front()}, {solids.begin() + 1, solids.end()}, all, pieces);
    gmsh::model::occ::synchronize();
  }
  for (std::size_t i = 0; i < solids.size(); ++i) {
    std::vector<int> tags;
    for (const auto& [dimension, tag] : pieces[i]) tags.push_back(tag);
    const int number = gmsh::model::addPhysicalGroup(3, tags, static_cast<int>(i + 1));
    if (!labels[i].empty()) gmsh::model::setPhysicalName(3, number, labels[i]);
  }
}

}  // namespace

MeshedBody mesh_solid(const MeshRequest& request) {
  MeshRequest r = request;
  GmshSession session({});
  gmsh::option::setString("Geometry.OCCTargetUnit", "M");
  gmsh::vectorpair shapes;
  gmsh::model::occ::importShapes(r.file.string(), shapes);
  session.stop_on_error(r.file);
  gmsh::model::occ::synchronize();
  gmsh::vectorpair volumes, surfaces;
  gmsh::model::getEntities(volumes, 3);
  if (volumes.empty()) refuse(r.file, "no solid in it (allowed: one solid; make one of its surfaces in a CAD program)");
  if (has_volumes(r)) {
    name_solids(volumes);
    session.stop_on_error(r.file);
    gmsh::model::getEntities(volumes, 3);
  }
  const double volume = model_volume();
  if (r.edge == 0) r.edge = r.scale * edge_for(r.tetrahedra, volume);
  refuse_too_many(r, volume * std::pow(r.scale, 3));
  gmsh::model::getBoundary(volumes, surfaces, true, false, false);
  int number = 0;
  for (const auto& [dimension, tag] : surfaces) {
    const int group = gmsh::model::addPhysicalGroup(2, {tag});
    gmsh::model::setPhysicalName(2, group, fmt::format("surface_{}", ++number));
  }
  want_edge(r.edge / r.scale);
  return of_solid(mesh_refined(r, model_at(r, session, r.edge)), volume);
}

namespace {

/// How files of an ending begin; `within` so many bytes.
struct Beginning {
  std::string_view extension, mark;
  std::size_t within;
  const char* words;
};

constexpr Beginning beginnings[] = {
    {".msh", "$MeshFormat", 0, "a gmsh mesh, which begins with $MeshFormat"},
    {".step", "ISO-10303-21", 256, "a STEP file, which begins with ISO-10303-21"},
    {".stp", "ISO-10303-21", 256, "a STEP file, which begins with ISO-10303-21"},
    {".brep", "CASCADE Topology", 256, "a BREP file, which begins with CASCADE Topology"},
};

std::string first_bytes(const std::filesystem::path& file, std::size_t count) {
  std::ifstream in(file, std::ios::binary);
  std::string bytes(count, '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(count));
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  return bytes;
}

/// gmsh takes for a script whatever it does not know, and runs it: the beginning of a .msh, .step, .stp or .brep file
/// is held against its ending.
/// @throws InputError
void require_kind(const std::filesystem::path& file) {
  const std::string extension = extension_of(file);
  const auto* kind = std::find_if(std::begin(beginnings), std::end(beginnings),
                                  [&](const Beginning& b) { return b.extension == extension; });
  if (kind == std::end(beginnings)) return;
  if (first_bytes(file, kind->within + kind->mark.size()).find(kind->mark) == std::string::npos)
    refuse(file, fmt::format("is not what its ending says (allowed: {}; a script for gmsh ends in .geo)", kind->words));
}

}  // namespace

MeshedBody mesh_file(const MeshRequest& r) try {
  require_kind(r.file);
  const std::string extension = extension_of(r.file);
  MeshedBody body = r.kind.vertices              ? vertices_of(r)
                    : r.kind.closed              ? closed_surface_of(r)
                    : extension == ".geo"        ? mesh_script(r)
                    : extension == ".msh"        ? mesh_msh(r)
                    : is_surface_file(extension) ? mesh_surface(r)
                                                 : mesh_solid(r);
  if (r.scale != 1) scale(body.mesh, r.scale);
  for (Mesh& mesh : body.coarser)
    if (r.scale != 1) scale(mesh, r.scale);
  for (Vec3& x : body.facets.points) x *= r.scale;
  body.smooth_volume *= std::pow(r.scale, 3);
  return body;
} catch (const std::string& message) {
  refuse(r.file, "gmsh: " + message);
}

}  // namespace springproof
