// gmsh's mesh files: our reading of what gmsh makes of them.  gmsh itself is not held to anything here (run.sh): it
// runs in a program of its own, springproof-mesh, and may crash or throw.
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <filesystem>

#include "fuzz/reader.h"
#include "meshes/gmsh/bodies.h"

namespace {

/// A file of these bytes, in memory, whose name ends in .msh.
const std::filesystem::path& file_of(const std::uint8_t* data, std::size_t size) {
  using namespace springproof;
  static const int memory = memfd_create("body", 0);
  static const std::filesystem::path file =
      std::filesystem::temp_directory_path() / fmt::format("springproof-fuzz-{}.msh", getpid());
  static const bool linked = symlink(fmt::format("/proc/self/fd/{}", memory).c_str(), file.c_str()) == 0 &&
                             std::atexit([] { unlink(file.c_str()); }) == 0;
  fuzz::require(linked && ftruncate(memory, 0) == 0 && pwrite(memory, data, size, 0) == ssize_t(size),
                "the bytes can be given");
  return file;
}

}  // namespace

#if __has_feature(address_sanitizer)
extern "C" const char* __lsan_default_suppressions() { return "leak:libgmsh"; }
#endif

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace springproof;
  return fuzz::read_or_refuse<std::exception>([&] {
    const MeshedBody body = mesh_file({.file = file_of(data, size)});
    fuzz::require(nodal_volumes(body.mesh).minCoeff() > 0, "each node has a volume");
  });
}
