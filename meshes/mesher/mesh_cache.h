// Meshes kept between runs: a body is meshed once, however often its cases are computed.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "meshes/mesher/mesher.h"

namespace springproof {

/// A place for one mesh among those in $SPRINGPROOF_MESH_CACHE, else $XDG_CACHE_HOME/springproof/meshes or
/// ~/.cache/springproof/meshes.  All of it is optional: what cannot be read is no mesh, what cannot be written is lost.
/// Thread-safe, also among processes.
class MeshCache {
 public:
  /// @param program the mesher.  The place changes with it, with the request, and with each file behind the body, by
  /// place, inode, size and time of change.  There is none for scripts that are not built in, as they may do anything,
  /// and none where the variable is empty.
  MeshCache(const MeshRequest& request, const std::filesystem::path& program);

  /// Nothing: it was never kept, or is damaged, which is said on stderr.
  std::optional<MeshedBody> find() const;

  /// @param answer of the mesher, in CBOR.  The meshes not used for longest go when there are more than 1 GB of them;
  /// files of others in the folder are neither counted nor removed.
  void keep(const std::string& answer) const;

 private:
  std::string key_;  ///< begins the content of each file; empty: no place
  std::filesystem::path file_;
};

}  // namespace springproof
