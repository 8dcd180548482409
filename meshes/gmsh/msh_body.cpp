#include <fmt/format.h>
#include <gmsh.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <set>

#include "meshes/gmsh/bodies.h"
#include "meshes/gmsh/read_mesh.h"
#include "meshes/gmsh/split_cells.h"
#include "meshes/patches/transfer_patches.h"
#include "problem/processes/child.h"

namespace springproof {
namespace {

/// "12 'Tetrahedron 4', 3 'Prism 6'".
std::string counts(const std::vector<ElementBlock>& blocks) {
  std::string words;
  for (const ElementBlock& b : blocks) words += fmt::format("{}{} '{}'", words.empty() ? "" : ", ", b.count(), b.name);
  return words;
}

/// All cells by their corners, each once (a file lists a cell once for each physical volume it is in).
ElementBlock corners_of(const std::vector<ElementBlock>& blocks) {
  ElementBlock all = blocks[0];
  all.nodes = all.corners;
  all.order = 1;
  all.node_tags.clear();
  std::set<std::vector<std::size_t>> seen;
  for (const ElementBlock& b : blocks)
    for (std::size_t i = 0; i < b.node_tags.size(); i += b.nodes) {
      std::vector<std::size_t> cell(b.node_tags.begin() + i, b.node_tags.begin() + i + b.corners);
      all.node_tags.insert(all.node_tags.end(), cell.begin(), cell.end());
      std::sort(cell.begin(), cell.end());
      if (!seen.insert(std::move(cell)).second) all.node_tags.resize(all.node_tags.size() - b.corners);
    }
  return all;
}

std::vector<int> entities(int dimension) {
  gmsh::vectorpair pairs;
  gmsh::model::getEntities(pairs, dimension);
  std::vector<int> tags;
  for (const auto& [d, tag] : pairs) tags.push_back(tag);
  return tags;
}

MeshedBody read_cells(const MeshRequest& r, const std::vector<ElementBlock>& blocks, std::vector<std::string> notes) {
  const std::size_t corners = blocks[0].corners;
  const bool alike = (corners == 4 || corners == 8) &&
                     std::all_of(blocks.begin(), blocks.end(), [&](const auto& b) { return b.corners == corners; });
  const bool filled_anew = r.edge > 0 || r.tetrahedra > 0;
  if (!alike && !filled_anew)
    refuse(r.file, fmt::format("mixed or unknown cells: {} (allowed: only tetrahedra or only hexahedra; others with "
                               "voxels or voxel_edge_m, which take the surface alone)",
                               counts(blocks)));
  MeshedBody body;
  body.notes = std::move(notes);
  if (std::any_of(blocks.begin(), blocks.end(), [](const auto& b) { return b.order > 1; }))
    body.notes.push_back(
        fmt::format("the cells of higher order ({}) are taken by their corners, with straight edges", counts(blocks)));
  body.mesh = read_mesh(r.file, alike ? corners_of(blocks) : split_into_tetrahedra(r.file, blocks), body.notes);
  return body;
}

/// The body of the file's cells, filled anew.
MeshedBody filled_anew(const MeshRequest& r, const MeshedBody& own) {
  const std::vector<OuterFacet> facets = outer_facets(own.mesh);
  MeshedBody body = fill_surface(r, outside_of(own.mesh, facets));
  body.coarser.push_back(std::move(body.mesh));
  for (Mesh& mesh : body.coarser) {
    mesh.patches.clear();
    transfer_patches(own.mesh, facets, mesh);
  }
  body.mesh = std::move(body.coarser.back());
  body.coarser.pop_back();
  body.notes.insert(body.notes.begin(), own.notes.begin(), own.notes.end());
  body.notes.push_back("the body is the surface of the file's cells, filled with tetrahedra of the length asked for");
  return body;
}

/// The triangles of the model.
Surface surface_of(const MeshRequest& r) {
  const auto blocks = elements(2, entities(2));
  if (blocks.empty())
    refuse(r.file, "no cells and no surface in it (allowed: tetrahedra, hexahedra, or a closed surface of triangles)");
  std::vector<std::size_t> tags;
  std::vector<double> coordinates, parametric;
  gmsh::model::mesh::getNodes(tags, coordinates, parametric, -1, -1, false, false);
  std::map<std::size_t, int> number;
  Surface surface;
  for (std::size_t i = 0; i < tags.size(); ++i) {
    number[tags[i]] = static_cast<int>(i);
    surface.points.emplace_back(coordinates[3 * i], coordinates[3 * i + 1], coordinates[3 * i + 2]);
  }
  for (const ElementBlock& b : blocks) {
    if (b.corners != 3)
      refuse(r.file, fmt::format("no cells, and a surface of {} (allowed: triangles)", counts(blocks)));
    for (std::size_t i = 0; i < b.node_tags.size(); i += b.nodes)
      surface.triangles.push_back(
          {number.at(b.node_tags[i]), number.at(b.node_tags[i + 1]), number.at(b.node_tags[i + 2])});
  }
  return surface;
}

}  // namespace

namespace {

/// gmsh, with the file's mesh.
class MshSession : public GmshSession {
 public:
  explicit MshSession(const std::filesystem::path& file) : GmshSession({}) {
    const TemporaryFolder alone;  // gmsh would also run FILE.opt beside it
    std::filesystem::create_symlink(std::filesystem::absolute(file), alone.path / "body.msh");
    gmsh::merge((alone.path / "body.msh").string());
    stop_on_error(file);
  }
};

}  // namespace

Surface vertices_of_msh(const MeshRequest& r) {
  const MshSession session(r.file);
  std::vector<std::size_t> tags;
  std::vector<double> coordinates, parametric;
  gmsh::model::mesh::getNodes(tags, coordinates, parametric, -1, -1, false, false);
  std::map<std::size_t, Vec3> nodes;
  for (std::size_t i = 0; i < tags.size(); ++i)
    nodes[tags[i]] = Vec3(coordinates[3 * i], coordinates[3 * i + 1], coordinates[3 * i + 2]);
  Surface surface;
  std::map<std::size_t, int> number;
  for (const auto& [tag, at] : nodes) {
    number[tag] = static_cast<int>(surface.points.size());
    surface.points.push_back(at);
  }
  for (const ElementBlock& b : elements(2, entities(2)))
    for (std::size_t i = 0; i < b.node_tags.size(); i += b.nodes)
      for (std::size_t c = 2; c < std::min<std::size_t>(b.corners, 4); ++c)
        surface.triangles.push_back(
            {number.at(b.node_tags[i]), number.at(b.node_tags[i + c - 1]), number.at(b.node_tags[i + c])});
  return surface;
}

MeshedBody mesh_msh(const MeshRequest& r) {
  Surface surface;
  std::vector<std::string> notes;
  std::optional<MeshedBody> own;
  {
    const MshSession session(r.file);
    gmsh::model::mesh::renumberNodes();  // a file's numbers may have gaps of any size
    if (const auto blocks = volume_elements(r.file, notes); !blocks.empty()) {
      own = read_cells(r, blocks, std::move(notes));
      if (r.edge == 0 && r.tetrahedra == 0) return *own;
    } else {
      surface = surface_of(r);
    }
    if (!own && r.edge == 0 && r.tetrahedra == 0)
      refuse(r.file,
             "edge: the file holds a surface and no cells; the length of the tetrahedra's edges is needed (allowed: > "
             "0 [m])");
    if (!own && !physical_surfaces().empty()) notes = {"the physical surfaces of a file without cells are not kept"};
  }
  if (own) return filled_anew(r, *own);
  MeshedBody body = fill_surface(r, surface);
  body.notes.insert(body.notes.begin(), notes.begin(), notes.end());
  return body;
}

}  // namespace springproof
