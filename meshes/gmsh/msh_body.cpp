#include <fmt/format.h>
#include <gmsh.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>

#include "meshes/gmsh/bodies.h"
#include "meshes/gmsh/read_mesh.h"
#include "meshes/mesher/refined_meshes.h"
#include "meshes/patches/transfer_patches.h"
#include "meshes/quality.h"
#include "meshes/regions/mark_regions.h"
#include "meshes/volume.h"
#include "problem/processes/child.h"

namespace springproof {
namespace {

/// "12 'Tetrahedron 4', 3 'Prism 6'".
std::string counts(const std::vector<ElementBlock>& blocks) {
  std::string words;
  for (const ElementBlock& b : blocks) words += fmt::format("{}{} '{}'", words.empty() ? "" : ", ", b.count(), b.name);
  return words;
}

/// All cells by their corners, each once (a file lists a cell once for each physical volume it is in), in the region
/// that one of its physical volumes is.
/// @throws InputError at a cell in two regions
std::vector<ElementBlock> once(const std::filesystem::path& file, const std::vector<ElementBlock>& blocks) {
  std::vector<ElementBlock> all;
  std::map<std::vector<std::size_t>, std::pair<std::size_t, std::size_t>> seen;  // corners, block and number in it
  for (const ElementBlock& b : blocks) {
    ElementBlock& own = all.emplace_back(ElementBlock{b.type, b.name, 1, b.corners, b.corners, {}, {}});
    for (std::size_t i = 0; i < b.count(); ++i) {
      const auto first = b.node_tags.begin() + static_cast<std::ptrdiff_t>(i * b.nodes);
      std::vector<std::size_t> cell(first, first + static_cast<std::ptrdiff_t>(b.corners));
      std::sort(cell.begin(), cell.end());
      const auto [at, is_new] = seen.try_emplace(std::move(cell), all.size() - 1, own.count());
      if (is_new) own.node_tags.insert(own.node_tags.end(), first, first + static_cast<std::ptrdiff_t>(b.corners));
      if (b.materials.empty()) continue;
      if (is_new) own.materials.push_back(b.materials[i]);
      std::uint8_t& there = all[at->second.first].materials[at->second.second];
      if (there > 0 && b.materials[i] > 0 && there != b.materials[i])
        refuse(file, "cells are in the physical volumes of two [[region]]s (allowed: each cell in one)");
      there = std::max(there, b.materials[i]);
    }
  }
  std::erase_if(all, [](const ElementBlock& b) { return b.node_tags.empty(); });
  return all;
}

/// Blocks of one kind of cells as one.
ElementBlock joined(const std::vector<ElementBlock>& blocks) {
  ElementBlock all = blocks.front();
  for (std::size_t b = 1; b < blocks.size(); ++b) {
    all.node_tags.insert(all.node_tags.end(), blocks[b].node_tags.begin(), blocks[b].node_tags.end());
    all.materials.insert(all.materials.end(), blocks[b].materials.begin(), blocks[b].materials.end());
  }
  return all;
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
  const std::vector<ElementBlock> cells = once(r.file, blocks);
  const bool whole = alike && !(filled_anew && has_volumes(r));
  body.mesh = read_mesh(r.file, whole ? joined(cells) : split_into_tetrahedra(r.file, cells), body.notes);
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

/// The same with the regions of the file's cells, along whose borders tetrahedra are cut.
MeshedBody filled_anew_with_regions(const MeshRequest& r, const MeshedBody& own) {
  MeshRequest whole = r;
  whole.volumes.clear();
  MeshedBody body = filled_anew(whole, own);
  std::vector<Mesh*> meshes = {&body.mesh};
  for (Mesh& mesh : body.coarser) meshes.push_back(&mesh);
  const double finest = static_cast<double>(body.mesh.tetrahedra.size());
  for (std::size_t number = 1; number <= r.volumes.size(); ++number) {
    Mesh region;
    region.nodes = own.mesh.nodes;
    for (std::size_t c = 0; c < own.mesh.tetrahedra.size(); ++c)
      if (own.mesh.materials[c] == number) region.tetrahedra.push_back(own.mesh.tetrahedra[c]);
    if (region.tetrahedra.empty()) continue;
    const Surface surface = outside_of(region);
    for (Mesh* mesh : meshes)
      mark_enclosed(surface, static_cast<std::uint8_t>(number),
                    std::cbrt(finest / static_cast<double>(mesh->tetrahedra.size())), *mesh);
  }
  body.notes.push_back("the borders of its regions are cut into these tetrahedra");
  return body;
}

/// The body of the file's cells, which say where its regions are: cut into eight until they are as small as asked for,
/// or filled anew if they became too many.
MeshedBody cut_finer(const MeshRequest& r, MeshedBody own) {
  constexpr std::size_t most = 400'000;  // of quadratic elements some 2 million unknowns
  const double inside = volume(own.mesh, own.mesh.nodes);
  const double edge = r.edge > 0 ? r.edge / r.scale : edge_for(r.tetrahedra, inside);
  const double coarsest = edge_of_regular(inside, static_cast<double>(own.mesh.tetrahedra.size()));
  const auto times =
      std::max(r.coarser.size(), static_cast<std::size_t>(std::max(0.0, std::round(std::log2(coarsest / edge)))));
  const double finest = static_cast<double>(own.mesh.tetrahedra.size()) * std::pow(8, times);
  if (finest > most) return filled_anew_with_regions(r, own);
  MeshedBody body{own.mesh, own.notes, r.scale * coarsest / std::pow(2, times), {}, {}, 0};
  for (std::size_t i = 0; i < times; ++i) {
    if (times - i <= r.coarser.size()) body.coarser.push_back(body.mesh);
    body.mesh = halved(body.mesh);
  }
  body.notes.push_back(fmt::format("the body is the file's {} tetrahedra, each cut into {} for the finest mesh",
                                   own.mesh.tetrahedra.size(), static_cast<long>(std::pow(8, times))));
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
  Surface surface;
  std::map<std::size_t, int> number;
  for (const auto& [tag, at] : node_positions()) {
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
    if (const auto blocks = volume_elements(r.file, r.volumes, notes); !blocks.empty()) {
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
  if (own) return has_volumes(r) ? cut_finer(r, *std::move(own)) : filled_anew(r, *own);
  MeshedBody body = fill_surface(r, surface);
  body.notes.insert(body.notes.begin(), notes.begin(), notes.end());
  return body;
}

}  // namespace springproof
