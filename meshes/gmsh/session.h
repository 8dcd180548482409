// gmsh under our rules: silent, its errors collected, its elements by type.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "problem/system/input_error.h"
#include "problem/vector.h"

namespace springproof {

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& message);

/// gmsh, started with the parameters of a .geo; stopped at the end of the scope.
class GmshSession {
 public:
  explicit GmshSession(const std::vector<std::pair<std::string, double>>& parameters);
  ~GmshSession();
  GmshSession(const GmshSession&) = delete;
  GmshSession& operator=(const GmshSession&) = delete;

  /// @throws InputError with the first error since the start or the last one thrown, if there is one.
  void stop_on_error(const std::filesystem::path& file) const;
};

/// Elements of one type.
struct ElementBlock {
  int type;          ///< gmsh's number
  std::string name;  ///< gmsh's, "Tetrahedron 10"
  int order;
  std::size_t nodes, corners;                ///< of one element; corners come first
  std::vector<std::size_t> node_tags;        ///< one element after the other
  std::vector<std::uint8_t> materials = {};  ///< of each element, as Mesh::materials; empty: one

  std::size_t count() const { return node_tags.size() / nodes; }
};

/// The elements of one dimension in these entities, by type.
/// @param materials of the entities that are in regions; empty: one
std::vector<ElementBlock> elements(int dimension, const std::vector<int>& entities,
                                   const std::map<int, std::uint8_t>& materials = {});

/// Elements of the physical volumes, each once; of the whole model if there are none.  Notes what is left out.
/// @param volumes the physical volume that each region is (MeshRequest::volumes)
/// @throws InputError if physical volumes are parts of the body and no region is one, which would be several materials;
/// if a region names none, or two regions name one part.
std::vector<ElementBlock> volume_elements(const std::filesystem::path& file, const std::vector<std::string>& volumes,
                                          std::vector<std::string>& notes);

struct PhysicalSurface {
  std::string name;  ///< its number if it has none
  std::vector<ElementBlock> facets;
};

std::vector<PhysicalSurface> physical_surfaces();

/// The model's entities of one dimension.
std::vector<int> entities(int dimension);

/// Of all nodes of the mesh, by their tags.
std::map<std::size_t, Vec3> node_positions();

}  // namespace springproof
