// springproof-mesh: reads a request, meshes the body, writes the answer (meshes/mesher/mesher_exchange.h).
#include <fmt/format.h>
#include <gmsh.h>
#include <sys/resource.h>
#include <unistd.h>

#include <fstream>
#include <new>

#include "meshes/gmsh/bodies.h"
#include "meshes/gmsh/session.h"
#include "meshes/mesher/mesher_exchange.h"
#include "problem/files/files.h"
#include "problem/system/streams.h"

namespace springproof {
namespace {

/// A mesh that outgrows the machine ends here and not by the system's choice of a victim.
void limit_memory() {
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
#ifndef __SANITIZE_ADDRESS__
  const auto bytes = static_cast<rlim_t>(sysconf(_SC_PHYS_PAGES)) / 4 * 3 * static_cast<rlim_t>(sysconf(_SC_PAGE_SIZE));
  const rlimit memory{bytes, bytes};
  setrlimit(RLIMIT_AS, &memory);
#endif
}

std::string answer_to(const MeshRequest& request) try {
  return to_cbor(mesh_file(request));
} catch (const InputError& e) {
  return refusal_to_cbor(e.what());
} catch (const std::bad_alloc&) {
  return refusal_to_cbor(request.file.string() +
                         ": too large a mesh for the memory of this machine (choose a longer edge)");
}

std::string library_versions() {
  const GmshSession session({});
  std::string gmsh;
  gmsh::option::getString("General.Version", gmsh);
  return fmt::format("gmsh {}, CGAL {}", gmsh, SPRINGPROOF_CGAL_VERSION);
}

int run(int argc, char** argv) try {
  if (argc == 2 && argv[1] == std::string("--version")) {
    to_stdout("{}\n", library_versions());
    return 0;
  }
  if (argc != 3) {
    to_stderr("usage: springproof-mesh REQUEST.cbor ANSWER.cbor   (run by springproof and springproof-fem)\n");
    return 2;
  }
  limit_memory();
  const std::string answer = answer_to(mesh_request_from_cbor(text_of_file(argv[1])));
  std::ofstream out(argv[2], std::ios::binary);
  out.write(answer.data(), static_cast<std::streamsize>(answer.size()));
  if (!out.flush()) throw std::runtime_error(fmt::format("cannot write {}", argv[2]));
  return 0;
} catch (const std::exception& e) {
  to_stderr("{}\n", e.what());
  return 1;
}

}  // namespace
}  // namespace springproof

int main(int argc, char** argv) {
  return springproof::run_as_program([&] { return springproof::run(argc, argv); });
}
