// Meshes kept between runs: a body is meshed once, however often its cases are computed.
#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>

#include "meshes/mesher/mesher.h"
#include "problem/files/kept_file.h"

namespace springproof {

/// Where meshes, and what is computed of them, are kept: $SPRINGPROOF_MESH_CACHE, else
/// $XDG_CACHE_HOME/springproof/meshes or ~/.cache/springproof/meshes; empty: nowhere.
std::filesystem::path kept_folder();

/// Of a file: another one in its place, or another content, has another line.
std::string line_of(const std::filesystem::path& file);

/// The file and, as gmsh scripts may include or merge others, every file that is named in one of its strings, those
/// files' own too. A '%' in a name stands for anything; names that a script puts together from pieces are not seen.
std::set<std::filesystem::path> files_behind(const std::filesystem::path& body);

/// A place for one mesh among those kept (problem/files/kept_file.h).
class MeshCache {
 public:
  /// @param program the mesher.  The place changes with it, with the request, and with each file behind the body, by
  /// place, inode, size and time of change.  There is none for scripts that are not built in, as they may do anything,
  /// and none where the variable is empty.
  MeshCache(const MeshRequest& request, const std::filesystem::path& program);

  /// Nothing: it was never kept, or is damaged, which is said on stderr.
  std::optional<MeshedBody> find() const;

  /// @param answer of the mesher, in CBOR
  void keep(const std::string& answer) const;

 private:
  KeptFile file_;
};

}  // namespace springproof
