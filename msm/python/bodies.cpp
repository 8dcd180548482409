// Python: materials, bodies, and files for ParaView.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <set>

#include "meshes/field.h"
#include "meshes/mesher/mesher.h"
#include "meshes/patches/select_patches.h"
#include "meshes/regions/mark_regions.h"
#include "meshes/voxels/voxelise.h"
#include "msm/python/bindings.h"
#include "problem/body.h"
#include "problem/files/files.h"

namespace springproof::python {
namespace {

namespace fs = std::filesystem;
using namespace py::literals;

constexpr int about_tetrahedra = 20000;  // of the true body, as in the finest mesh of compare

using OptionalNumber = std::optional<double>;

IsotropicMaterial material_of(OptionalNumber E, OptionalNumber nu, OptionalNumber G, OptionalNumber K,
                              OptionalNumber lambda, double density) {
  const IsotropicMaterial material = material_from({E, nu, G, K, lambda}, density);
  check(material);
  return material;
}

PatchRule rule_of(const std::string& name, const std::optional<std::pair<Numbers, Numbers>>& box,
                  const std::optional<std::pair<Numbers, Numbers>>& beyond,
                  const std::optional<std::pair<Numbers, double>>& facing,
                  const std::optional<std::pair<Numbers, double>>& near) {
  const auto direction = [&](const Numbers& values, const char* key) -> Vec3 {
    const Vec3 v = vector_of(values, key);
    if (!(v.norm() > 0)) throw InputError(fmt::format("{}: {}: is zero (allowed: a direction)", name, key));
    return v.normalized();
  };
  PatchRule rule;
  rule.name = name;
  if (box) rule.box = PatchRule::Box{vector_of(box->first, "box"), vector_of(box->second, "box")};
  if (box && !((rule.box->high - rule.box->low).minCoeff() > 0))
    throw InputError(fmt::format("{}: box: is empty (allowed: the lower corner, then the higher one)", name));
  if (beyond) rule.beyond = PatchRule::Beyond{vector_of(beyond->first, "beyond"), direction(beyond->second, "beyond")};
  if (facing) rule.facing = PatchRule::Facing{direction(facing->first, "facing"), facing->second};
  if (near) rule.near = PatchRule::Near{vector_of(near->first, "near"), near->second};
  if (!box && !beyond && !facing && !near)
    throw InputError(
        fmt::format("patch: '{}' does not say where it lies (allowed: one or more of box, beyond, facing, "
                    "near)",
                    name));
  return rule;
}

constexpr double of_body = 0;  // scale of a region's surface that is not given

/// The regions of a body whose file has that scale.
std::vector<MaterialRegion> scaled(std::vector<MaterialRegion> regions, double scale) {
  constexpr std::size_t most = 255;  // numbers of Mesh::materials
  if (regions.size() > most)
    throw InputError(fmt::format("regions: there are {} (allowed: up to {})", regions.size(), most));
  std::set<std::string> names;
  for (MaterialRegion& region : regions) {
    if (!names.insert(region.name).second)
      throw InputError(fmt::format("regions: '{}' is the name of two (allowed: a name of its own)", region.name));
    if (auto* enclosed = std::get_if<EnclosedPlace>(&region.place); enclosed && enclosed->scale == of_body)
      enclosed->scale = scale;
  }
  return regions;
}

MaterialRegion region_of_place(const std::string& name, const IsotropicMaterial& material,
                               const std::optional<std::string>& volume,
                               const std::optional<std::pair<Numbers, Numbers>>& box,
                               const std::optional<std::pair<Numbers, double>>& near,
                               const std::optional<std::pair<Numbers, Numbers>>& beyond,
                               const std::optional<fs::path>& stl, std::optional<double> scale) {
  if (volume.has_value() + box.has_value() + near.has_value() + beyond.has_value() + stl.has_value() != 1)
    throw InputError(
        fmt::format("region: '{}' needs one place (allowed: one of volume, box, near, beyond, stl)", name));
  MaterialRegion region{name, material, {}, {}};
  if (volume)
    region.place = *volume;
  else if (stl)
    region.place = EnclosedPlace{*stl, scale.value_or(of_body)};
  else {
    const PatchRule rule = rule_of(name, box, beyond, {}, near);
    box ? region.place = *rule.box : near ? region.place = *rule.near : region.place = *rule.beyond;
  }
  return region;
}

std::shared_ptr<SolidBody> block_of(const Vec3& size, const Cells& cells) {
  for (int d = 0; d < 3; ++d)
    if (!(size[d] > 0) || !std::isfinite(size[d]))
      throw InputError(fmt::format("size: is {} along {} (allowed: a finite length > 0 [m])", size[d], "xyz"[d]));
  for (int d = 0; d < 3; ++d)
    if (cells[d] < 1 || cells[d] > 1000)
      throw InputError(fmt::format("cells: is {} along {} (allowed: 1 to 1000)", cells[d], "xyz"[d]));
  SolidBody body;
  body.mesh = std::make_shared<Mesh>(block_mesh(size, cells));
  return std::make_shared<SolidBody>(std::move(body));
}

/// A file by its path, else one of the built-in bodies, which come with the package.
fs::path find_body(const fs::path& file, const Vec3& size, double scale) {
  Body body;
  body.geo = file.filename().string();
  body.size = size;
  body.scale = scale;
  std::error_code ignored;
  if (fs::is_regular_file(file, ignored)) return find_geo(body, fs::absolute(file));
  const fs::path package = py::module_::import("springproof").attr("__file__").cast<fs::path>().parent_path();
  body.geo = file.string();
  return find_geo(body, package / "geo" / "body");
}

SolidBody cut_out(const MeshRequest& request, std::optional<double> edge, int cubes,
                  const std::vector<PatchRule>& patches, const std::vector<MaterialRegion>& regions) try {
  MeshedBody meshed = mesh_to_cut(request);
  SolidBody body;
  body.notes = std::move(meshed.notes);
  body.regions = regions;
  for (std::string& note : mark_regions(regions, 1, meshed.mesh)) body.notes.push_back(std::move(note));
  for (std::string& note : select_patches(patches, meshed.mesh)) body.notes.push_back(std::move(note));
  body.tetrahedra = std::make_shared<Mesh>(std::move(meshed.mesh));
  body.region = std::make_shared<Region>(region_of(*body.tetrahedra));
  const VoxelGrid grid = voxel_grid(*body.tetrahedra, edge.value_or(std::cbrt(body.region->volume / cubes)));
  Voxels voxels = voxelise(grid, *body.tetrahedra);
  body.notes.insert(body.notes.end(), voxels.notes.begin(), voxels.notes.end());
  body.mesh = std::make_shared<Mesh>(std::move(voxels.mesh));
  body.cut = std::make_shared<CutBody>(cut_body(grid, *body.tetrahedra));
  return body;
} catch (const std::invalid_argument& e) {
  throw InputError(SourceLocation{request.file.string(), 0, 0}, e.what());
}

std::shared_ptr<SolidBody> voxels_of(const fs::path& file, int cubes, std::optional<double> edge, double scale,
                                     const std::optional<Numbers>& size, const std::vector<PatchRule>& patches,
                                     const std::vector<MaterialRegion>& regions) {
  MeshRequest request;
  request.volumes = volumes_of(regions);
  request.size = size ? vector_of(*size, "size") : Vec3::Zero();
  request.file = find_body(file, request.size, scale);
  request.scale = scale;
  request.tetrahedra = about_tetrahedra;
  if (fs::path(file).extension() == ".geo" && !size)
    throw InputError(fmt::format("{}: a script needs its size (allowed: size = (x, y, z) [m])", file.string()));
  if (edge && (!(*edge > 0) || !std::isfinite(*edge)))
    throw InputError(fmt::format("edge: is {} (allowed: a length > 0 [m])", *edge));
  if (cubes < 1 || cubes > 4000000) throw InputError(fmt::format("cubes: is {} (allowed: 1 to 4000000)", cubes));
  return long_call(
      [&] { return std::make_shared<SolidBody>(cut_out(request, edge, cubes, patches, scaled(regions, scale))); });
}

py::dict patches_of(const SolidBody& body) {
  py::dict out;
  for (const Patch& p : body.mesh->patches) out[py::str(p.name)] = indices(nodes_of(p));
  return out;
}

void write_vtu_of(const fs::path& file, const SolidBody& body, const Numbers& displacement, const py::kwargs& arrays) {
  const Eigen::Index nodes = body.mesh->nodes.rows();
  Field field;
  field.mesh = body.mesh;
  field.displacement = rows_of(displacement, "displacement", nodes);
  NodalFields extra;
  for (const auto& [name, values] : arrays) {
    const auto key = name.cast<std::string>();
    extra.emplace_back(key, rows_of(values.cast<Numbers>(), key.c_str(), nodes));
  }
  write_vtu(end_of_links(file), field, extra);
}

void bind_material(py::module_& m) {
  py::class_<IsotropicMaterial>(m, "Material", R"(An isotropic elastic solid, by exactly two of its moduli.

E, G, K, lame_lambda [Pa] and density [kg/m^3] are positive (lame_lambda may be negative), -1 < nu < 1/2.
Raises InputError for anything else.)")
      .def(py::init(&material_of), "E"_a = py::none(), "nu"_a = py::none(), py::kw_only(), "G"_a = py::none(),
           "K"_a = py::none(), "lame_lambda"_a = py::none(), "density"_a = 1000.0)
      .def_readonly("E", &IsotropicMaterial::youngs_modulus, "Young's modulus [Pa]")
      .def_readonly("nu", &IsotropicMaterial::poisson_ratio, "Poisson's ratio")
      .def_readonly("density", &IsotropicMaterial::density, "[kg/m^3]")
      .def_property_readonly("G", &shear_modulus, "shear modulus [Pa]")
      .def_property_readonly("K", &bulk_modulus, "bulk modulus [Pa]")
      .def_property_readonly("lame_lambda", &springproof::lame_lambda, "Lame's first parameter [Pa]")
      .def("__repr__", [](const IsotropicMaterial& s) {
        return fmt::format("Material(E={:g}, nu={:g}, density={:g})", s.youngs_modulus, s.poisson_ratio, s.density);
      });
}

}  // namespace

void bind_bodies(py::module_& m) {
  bind_material(m);
  py::class_<PatchRule>(m, "Patch", R"(A part of a body's surface: where all of the given conditions hold.

box: its lower and its higher corner [m]; beyond: a point [m] and the normal of a plane, on the side of which it lies;
facing: a direction and the largest angle to it [degrees]; near: a point [m] and a radius [m].)")
      .def(py::init(&rule_of), "name"_a, py::kw_only(), "box"_a = py::none(), "beyond"_a = py::none(),
           "facing"_a = py::none(), "near"_a = py::none())
      .def_readonly("name", &PatchRule::name);
  py::class_<MaterialRegion>(m, "Region",
                             R"(A part of a body of another material, in one place; where two overlap, the later.

volume: of the body's file, by name or number; box, near, beyond: as of a Patch; stl: a file of a closed surface, whose
coordinates `scale` multiplies, if given, else that of the body.)")
      .def(py::init(&region_of_place), "name"_a, "material"_a, py::kw_only(), "volume"_a = py::none(),
           "box"_a = py::none(), "near"_a = py::none(), "beyond"_a = py::none(), "stl"_a = py::none(),
           "scale"_a = py::none())
      .def_readonly("name", &MaterialRegion::name)
      .def_readonly("material", &MaterialRegion::material);
  py::class_<SolidBody, std::shared_ptr<SolidBody>>(
      m, "Body", R"(A body in cubes, made by block() or voxels(), or in tetrahedra, as compare() hands it out.)")
      .def_property_readonly(
          "nodes", [](const py::object& self) { return view(self.cast<SolidBody&>().mesh->nodes, self); },
          "corners of the cubes at rest, n x 3 [m]; a view")
      .def_property_readonly(
          "cells", [](const py::object& self) { return view(self.cast<SolidBody&>().mesh->hexahedra, self); },
          "corners of each cube, c x 8, in the order of VTK's hexahedron; a view")
      .def_property_readonly(
          "tetrahedra", [](const py::object& self) { return view(self.cast<SolidBody&>().mesh->tetrahedra, self); },
          "corners of each tetrahedron, t x 4, of the body that compare() hands to a function; of cubes none; a view")
      .def_property_readonly("patches", &patches_of, "name -> numbers of the patch's nodes, ascending")
      .def_property_readonly(
          "edge", [](const SolidBody& b) { return b.mesh->grid ? b.mesh->grid->spacing.maxCoeff() : 0.0; },
          "edge of the cubes [m]")
      .def_readonly("notes", &SolidBody::notes, "what was repaired or left out of the body");
  m.def(
      "block", [](const Numbers& size, const Cells& cells) { return block_of(vector_of(size, "size"), cells); },
      "size"_a, "cells"_a,
      R"(A block from the origin to `size` [m], in (nx, ny, nz) cubes; patches x_min x_max y_min y_max z_min z_max.)");
  m.def(
      "voxels", &voxels_of, "file"_a, "cubes"_a = 2000, py::kw_only(), "edge"_a = py::none(), "scale"_a = 1.0,
      "size"_a = py::none(), "patches"_a = std::vector<PatchRule>(), "regions"_a = std::vector<MaterialRegion>(),
      R"(A closed body (.stl, .obj, .ply, .msh, .step, .stp, .brep, .geo, or a built-in one as "rabbit.stl") in about `cubes` cubes,
or in cubes of `edge` [m]; `scale` multiplies its coordinates, `size` [m] is that of a script for gmsh.

Runs the program springproof-mesh.  Raises InputError for a body that cannot be meshed.)");
  m.def(
      "write_vtu", &write_vtu_of, "file"_a, "body"_a, "displacement"_a,
      R"(A file for ParaView: the cubes, their displacement n x 3 [m], relative change of volume, and further arrays n x 3
of nodes by their names.)");
  m.def(
      "write_pvd",
      [](const fs::path& file, const std::vector<std::pair<double, std::string>>& series) { write_pvd(file, series); },
      "file"_a, "series"_a, "A series for ParaView: (time [s], name of a .vtu beside the file) of each picture.");
}

}  // namespace springproof::python
