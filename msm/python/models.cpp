// Python: models of the table and springs files, their arrays, and what is measured of them.
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <thread>

#include "msm/coarsening/measure_cells.h"
#include "msm/dynamics/time_step.h"
#include "msm/measure/moduli.h"
#include "msm/parameters/model_options.h"
#include "msm/periodic/bulk_calibration.h"
#include "msm/periodic/homogenise.h"
#include "msm/periodic/laws_of_model.h"
#include "msm/python/bindings.h"
#include "msm/springs_of_model.h"

namespace springproof::python {
namespace {

namespace fs = std::filesystem;
using namespace py::literals;

constexpr int random_nodes = 1331, lattice_nodes = 27;  // of a periodic cell, as `springproof homogenise`

ModelParameters parameters_of(const std::string& name, const py::kwargs& options) {
  return resolve({name, options_of(options), name, {}});
}

std::shared_ptr<BodyModel> finished(BodyModel model) {
  model.mass = masses(model.network(), model.springs.density);
  return std::make_shared<BodyModel>(std::move(model));
}

/// Cut cells measured in finer ones.
/// @throws std::invalid_argument where averaged springs are as good
EmbeddedModel build_measured(ModelParameters p, const SolidBody& body, const std::vector<std::string>& held,
                             const IsotropicMaterial& material) {
  p.coarsened = false;
  EmbeddedModel built = build_cut(p, *body.cut, held, *body.mesh, material);
  const AveragedSprings law = measuring_law(p, material);
  const FineCells fine = fine_cells(*body.cut, *body.tetrahedra, measuring_ratio);
  MeasureOptions options;
  options.threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  const MeasuredBody measured = measure_cells({*body.cut, fine, law, held}, options);
  describe(measured);
  erase_laws<AveragedSprings>(built.model);
  built.model.laws.emplace_back(in_material(measured.cells, built.model.network.cells, law, averaged_law(p, material)));
  return built;
}

std::shared_ptr<BodyModel> build(const std::string& name, const std::shared_ptr<SolidBody>& body,
                                 const IsotropicMaterial& material, const std::vector<std::string>& held,
                                 const std::vector<AttachedMass>& masses, const py::kwargs& options) {
  BodyModel made;
  made.masses = masses;
  made.parameters = parameters_of(name, options);
  made.body = body;
  const bool cut = made.parameters.cut.value_or(false);
  if (made.parameters.coarsened.value_or(false) && !cut)
    throw InputError(fmt::format("{}: coarsened: is for cut cells (allowed: with cut = True)", name));
  if (cut && !body->cut)
    throw InputError(fmt::format("{}: cut = True: the body is a block (allowed: a body by voxels())", name));
  if (!cut && !held.empty())
    throw InputError(fmt::format("{}: held: is for cut cells (allowed: with cut = True)", name));
  if (!body->regions.empty() && (!has_cut_cells(made.parameters.row) || made.parameters.coarsened.value_or(false)))
    throw InputError(
        fmt::format("{}: is of one material here (allowed for a body of regions: lattices of cells without "
                    "momentum dispersion, not coarsened)",
                    name));
  for (const std::string& on : held) patch(*body->tetrahedra, on);
  EmbeddedModel built = long_call([&] {
    if (made.parameters.coarsened.value_or(false)) return build_measured(made.parameters, *body, held, material);
    return cut ? build_cut(made.parameters, *body->cut, held, *body->mesh, material, materials_of(body->regions))
               : build_embedded(made.parameters, *body->mesh, material, body->region.get(),
                                materials_of(body->regions));
  });
  attach(masses, *body->mesh, built.embedding, built.model.network);
  made.embedding = std::move(built.embedding);
  SpringsFile& springs = made.springs;
  springs.model = std::move(built.model);
  springs.density = material.density;
  springs.material = material;
  for (const MaterialRegion& r : body->regions) springs.regions.push_back({r.name, r.material});
  springs.grip = grip_of(made.parameters, *body->mesh);
  springs.grip_from_cells = made.parameters.row.topology != Topology::random;
  springs.patches = made.embedding.held;
  springs.origin = {"springproof", name, options_of(options), "", ""};
  return finished(std::move(made));
}

std::shared_ptr<BodyModel> read(const std::string& text, const std::string& name) {
  BodyModel made;
  made.springs = long_call([&] { return parse_springs(text, name); });
  made.parameters.row.name = name;
  return finished(std::move(made));
}

void write(const BodyModel& model, const fs::path& file) {
  require_springs_ending(file);
  if (model.network().cells.cut())
    throw InputError(
        fmt::format("{}: cut = True: is not written from here (allowed: cut = False; or springproof export)",
                    model.parameters.row.name));
  long_call([&] {
    SpringsFile springs = model.springs;
    if (model.body)
      springs.surface =
          carried_surface(surface_of_mesh(model.body->tetrahedra ? *model.body->tetrahedra : *model.body->mesh),
                          *model.body->mesh, springs.model.network, model.embedding);
    springs.derived = derived_of(springs);
    write_springs(file, springs);
    return 0;
  });
}

py::list table() {
  py::list rows;
  for (const ModelRow& row : model_table())
    rows.append(py::dict("name"_a = row.name, "what"_a = row.what, "made_of"_a = made_of(row),
                         "poisson_ratio"_a = own_poisson_ratio(row),
                         "large_displacements"_a = can(row, Capability::large_displacements),
                         "cut_cells"_a = has_cut_cells(row)));
  return rows;
}

py::array springs_view(const py::object& self) {
  const auto& springs = self.cast<BodyModel&>().network().springs;
  return view(springs.data(), {py::ssize_t(springs.size())}, self);
}

py::dict moduli_of(const IsotropicMaterial& m, double E, double nu, double G, double K) {
  return py::dict("E"_a = E, "nu"_a = nu, "G"_a = G, "K"_a = K, "wanted"_a = m);
}

py::dict homogenise_model(const std::string& name, const IsotropicMaterial& material, double spacing,
                          std::optional<int> nodes, const py::kwargs& options) {
  const ModelParameters p = parameters_of(name, options);
  if (!(spacing > 0)) throw InputError(fmt::format("spacing: is {} (allowed: a length > 0 [m])", spacing));
  const int about = nodes.value_or(p.row.topology == Topology::random ? random_nodes : lattice_nodes);
  if (about < 1 || about > 1000000) throw InputError(fmt::format("nodes: is {} (allowed: 1 to 1000000)", about));
  const auto [h, own] = long_call([&] {
    const MassSpringModel model = periodic_model(p, material, spacing, about);
    return std::pair(homogenise(model), model.network.nodes());
  });
  py::dict out = moduli_of(material, h.youngs_modulus, h.poisson_ratio, h.shear_modulus, h.bulk_modulus);
  py::array_t<double> C({6, 6});
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) C.mutable_at(i, j) = h.C(i, j);
  out["C"] = C;
  out["anisotropy"] = h.anisotropy;
  out["asymmetry"] = h.asymmetry;
  out["nodes"] = own;
  return out;
}

py::dict measure(const std::string& name, const IsotropicMaterial& material, int cells, const py::kwargs& options) {
  const ModelParameters p = parameters_of(name, options);
  if (cells < 2 || cells > 40) throw InputError(fmt::format("cells: is {} (allowed: 2 to 40)", cells));
  const MeasuredModuli m = long_call([&] { return measure_moduli(p, material, cells); });
  const double E = m.youngs_modulus, nu = m.poisson_ratio;
  return moduli_of(material, E, nu, m.shear_modulus, E / (3 * (1 - 2 * nu)));
}

}  // namespace

std::map<std::string, std::variant<bool, double, std::string>> options_of(const py::dict& given) {
  std::map<std::string, std::variant<bool, double, std::string>> options;
  for (const auto& [key, value] : given)
    if (const auto name = key.cast<std::string>(); py::isinstance<py::bool_>(value))
      options[name] = value.cast<bool>();
    else if (py::isinstance<py::str>(value))
      options[name] = value.cast<std::string>();
    else
      options[name] = value.cast<double>();
  return options;
}

void bind_models(py::module_& m) {
  PYBIND11_NUMPY_DTYPE(Spring, i, j, stiffness, rest_length);
  py::class_<BodyModel, std::shared_ptr<BodyModel>> model(m, "Model", R"(A mass-spring model of a body.

name: a row of models(); options: those of a case file, as face_to_cube=1, seed=2, curve="neo_hooke"; cut=True: cells
cut along the true surface, with `held`, the patches that supports will hold; coarsened=True: these cells measured in
finer ones; masses: Mass(...) on the body.  Raises InputError for what does not suit
the model.)");
  model
      .def(py::init(&build), "name"_a, "body"_a, "material"_a, py::kw_only(), "held"_a = std::vector<std::string>(),
           "masses"_a = std::vector<AttachedMass>())
      .def_property_readonly(
          "name", [](const BodyModel& b) { return b.parameters.row.name; }, "row of models(), or file")
      .def_property_readonly(
          "positions", [](const py::object& self) { return view(self.cast<BodyModel&>().network().X, self); },
          "nodes at rest, n x 3 [m]; a view")
      .def_property_readonly(
          "masses",
          [](const py::object& self) {
            const auto& mass = self.cast<BodyModel&>().mass;
            return view(mass.data(), {mass.size()}, self);
          },
          "of the nodes, n [kg]; a view")
      .def_property_readonly("springs", &springs_view,
                             "s records (i, j, stiffness [N/m], rest_length [m]) of springs, i < j; a view")
      .def_property_readonly(
          "cells", [](const py::object& self) { return view(self.cast<BodyModel&>().network().cells.corners, self); },
          "corners of each cell, c x 8, none for networks without cells; a view")
      .def_property_readonly(
          "cell_materials",
          [](const BodyModel& b) {
            std::vector<int> materials;
            for (std::size_t c = 0; c < b.network().cells.size(); ++c)
              materials.push_back(b.network().cells.material(c));
            return indices(materials);
          },
          "of each cell, c: 0 in no region, 1, 2, ... in the regions of the body")
      .def_property_readonly(
          "patches",
          [](const BodyModel& b) {
            py::dict out;
            for (const auto& [name, nodes] : b.springs.patches) out[py::str(name)] = indices(nodes);
            return out;
          },
          "name -> nodes that a support of this patch holds, ascending")
      .def_property_readonly(
          "density", [](const BodyModel& b) { return b.springs.density; }, "[kg/m^3]")
      .def_property_readonly(
          "material", [](const BodyModel& b) { return b.springs.material; },
          "what the springs stand for; None: not known")
      .def_property_readonly(
          "safe_time_step",
          [](const BodyModel& b) {
            return long_call([&] {
              const SpringsFile& s = b.springs;
              return relaxing_time_step(s.model, s.density, s.relaxing, safe_time_step(s.model, s.density));
            });
          },
          "largest step of undamped explicit integration about rest [s]")
      .def(
          "forces",
          [](const BodyModel& b, const Numbers& positions) {
            const NodalVectors x = rows_of(positions, "positions", b.network().nodes());
            return moved(long_call([&] { return forces(b.model(), x); }));
          },
          "positions"_a, "Internal forces at these positions, n x 3 [N].")
      .def(
          "energy",
          [](const BodyModel& b, const Numbers& positions) {
            const NodalVectors x = rows_of(positions, "positions", b.network().nodes());
            return long_call([&] { return energy(b.model(), x); });
          },
          "positions"_a, "Elastic energy at these positions [J] of a model whose forces have a potential.")
      .def(
          "on_body",
          [](const BodyModel& b, const Numbers& values) {
            if (!b.body) throw InputError(b.parameters.row.name + ": has no body (allowed: models of a body)");
            return moved(b.embedding.weights * rows_of(values, "values", b.network().nodes()));
          },
          "values"_a, "Vectors of the network's nodes, n x 3, carried over to the body's nodes.")
      .def("write", &write, "file"_a, "A springs file: .json, .npz or .vtu, by the ending of the name.")
      .def("__repr__", [](const BodyModel& b) {
        return fmt::format("<springproof.Model {}: {} nodes, {} springs, {} cells>", b.parameters.row.name,
                           b.network().nodes(), b.network().springs.size(), b.network().cells.size());
      });
  bind_statics(m, model);
  bind_motion(m, model);
  m.def("_parse_springs", &read, "text"_a, "name"_a, "The model of a springs file's text (JSON).");
  m.def("models", &table,
        "The table of models: name, what, poisson_ratio (the only one; None: any), large_displacements, cut_cells.");
  m.def(
      "homogenise", &homogenise_model, "name"_a, "material"_a, py::kw_only(), "spacing"_a = 0.1, "nodes"_a = py::none(),
      R"(Effective moduli of an infinite periodic network of the model, its nodes relaxed, as `springproof homogenise`.

Returns E, G, K [Pa], nu, C (6 x 6 [Pa], xx yy zz yz zx xy, engineering shear strains), anisotropy, asymmetry, nodes, and
the material that was wanted.  Further keywords are options of the model.)");
  m.def(
      "measure_moduli", &measure, "name"_a, "material"_a, py::kw_only(), "cells"_a = 4,
      R"(Moduli E, G, K [Pa], nu of a free block of `cells` cubed cells of the model, as `springproof material` measures them.)");
}

}  // namespace springproof::python
