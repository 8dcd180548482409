// Answers of springproof-mesh.  A mesh that is taken over must be fit for the loops over its cells, nodes and patches.
#include <fstream>
#include <stdexcept>

#include "fuzz/reader.h"
#include "meshes/locate/locate.h"
#include "meshes/locate/outer_facets.h"
#include "meshes/mesher/mesher_exchange.h"

namespace {

void walk(const springproof::Mesh& mesh) {
  using namespace springproof;
  nodal_volumes(mesh);
  outer_facets(mesh);
  separate_parts(mesh);
  detect_grid(mesh);
  if (mesh.grid) locate(mesh, mesh.grid->origin);
  for (const Patch& p : mesh.patches) {
    nodal_areas(mesh, p);
    centroid(mesh, p);
  }
}

/// Hexahedra with a grid, patches and curved edges; tetrahedra.
springproof::MeshedBody example() {
  using namespace springproof;
  MeshedBody body{block_mesh({1, 1, 1}, {1, 1, 2}), {"a note"}, 0.5, {Mesh()}, {}, 0};
  body.facets = outside_of(body.mesh);
  body.mesh.curved = NodalVectors::Zero(27 * 2, 3);
  body.coarser[0].nodes = body.mesh.nodes.topRows(5);
  body.coarser[0].tetrahedra = {{0, 1, 2, 4}};
  body.coarser[0].patches = {{"foot", {{0, 2, 1, -1}}}};
  return body;
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  return springproof::fuzz::write_seed(
      [](const char* file) { std::ofstream(file, std::ios::binary) << to_cbor(example()); });
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace springproof;
  return fuzz::read_or_refuse<std::runtime_error>([&] {
    const MeshedBody body = answer_from_cbor(std::string(fuzz::view(data, size)));
    walk(body.mesh);
    for (const Mesh& mesh : body.coarser) walk(mesh);
    centroid(body.facets);
  });
}
