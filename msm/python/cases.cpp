// Python: what compare() hands to a model of the user's own.
#include <algorithm>
#include <cmath>
#include <limits>

#include "meshes/mesher/mesher.h"
#include "meshes/patches/select_patches.h"
#include "msm/python/bindings.h"
#include "problem/case_file/experiment.h"

namespace springproof::python {
namespace {

namespace fs = std::filesystem;
using namespace py::literals;

constexpr double tetrahedra_per_cube = 5.8;  // of the cube's edge

/// The body in tetrahedra as fine as the finest of the case's lattices; the vertices of a block are the lattice's
/// nodes.
std::shared_ptr<SolidBody> in_tetrahedra(const Experiment& e) {
  const Body& body = e.body;
  const fs::path geo = find_geo(body, e.file);
  SolidBody out;
  Mesh mesh;
  if (!body.is_voxels()) {
    const Cells finest = *std::max_element(body.cells.begin(), body.cells.end(), [](const Cells& a, const Cells& b) {
      return double(a[0]) * a[1] * a[2] < double(b[0]) * b[1] * b[2];
    });
    mesh = mesh_geo(geo, body.size, finest, {.tetrahedra = true});
    select_patches(e.patches, mesh);
  } else {
    MeshRequest request;
    request.file = geo;
    request.size = body.size;
    request.scale = body.scale;
    if (!body.voxel_edges.empty())
      request.edge = *std::min_element(body.voxel_edges.begin(), body.voxel_edges.end());
    else
      request.tetrahedra = static_cast<int>(
          std::lround(tetrahedra_per_cube * *std::max_element(body.voxel_counts.begin(), body.voxel_counts.end())));
    MeshedBody meshed = mesh_body(request);
    mesh = std::move(meshed.mesh);
    out.notes = std::move(meshed.notes);
    for (std::string& note : select_patches(e.patches, mesh)) out.notes.push_back(std::move(note));
  }
  out.mesh = std::make_shared<Mesh>(std::move(mesh));
  return std::make_shared<SolidBody>(std::move(out));
}

/// [(body, material, forces n x 3, displacement n x 3)], one for each material of the case.
py::list problems_of(const fs::path& file) {
  const Experiment e = read_experiment(file);
  require_one_material(e, "springs in Python");
  const std::shared_ptr<SolidBody> body = long_call([&] { return in_tetrahedra(e); });
  py::list all;
  for (const IsotropicMaterial& material : e.materials) {
    BoundaryConditions bc = transfer(e.loads, *body->mesh, material.density, e.model_kinematics());
    for (std::size_t unknown = 0; unknown < bc.fixed.size(); ++unknown)
      if (!bc.fixed[unknown]) bc.prescribed.data()[unknown] = std::numeric_limits<double>::quiet_NaN();
    all.append(
        py::make_tuple(body, e.at_rest(material), moved(std::move(bc.external)), moved(std::move(bc.prescribed))));
  }
  return all;
}

}  // namespace

void bind_cases(py::module_& m) {
  m.def(
      "_problems_of", &problems_of, "file"_a,
      "Of a case file, for each material: body in tetrahedra, material, forces and prescribed displacements of nodes.");
}

}  // namespace springproof::python
