#include "comparisons/engines/engine_files.h"

#include <fmt/format.h>

#include <iterator>

#include "comparisons/engines/engine_constants.h"
#include "meshes/locate/outer_facets.h"
#include "msm/exchange/springs_document.h"
#include "msm/parameters/model_table.h"

namespace springproof {
namespace {

using OrderedJson = nlohmann::ordered_json;  // not Json, which is another type in sources of the same unit

constexpr double standard_gravity = 9.81, slowest_frame = 1.0 / 60;

void require_cubes(const SpringsFile& springs, const char* engine) {
  const Network& network = springs.model.network;
  if (network.cells.empty() || network.cells.cut())
    throw InputError(
        fmt::format("--model: {}: its nodes are not the corners of whole cubes, which {} gets (allowed: a "
                    "lattice of cells, as msm_18, on whole cubes)",
                    springs.origin.model, engine));
}

void require_springs_alone(const SpringsFile& springs) {
  if (!consists_of<Springs>(springs.model)) {
    std::vector<std::string> able;
    for (const ModelRow& row : model_table())
      if (row.topology == Topology::cells && of_springs_alone(row)) able.push_back(row.name);
    throw InputError(
        fmt::format("--model: {} has more than springs, and Jolt has no term for the volume of a cube: its "
                    "volume constraints are of single tetrahedra, which lock (allowed: {})",
                    springs.origin.model, fmt::join(able, ", ")));
  }
  const auto require_quarter = [](const std::string& what, double ratio) {
    if (!same_poisson_ratio(ratio, 0.25))
      throw InputError(
          fmt::format("{}: is {:g}, and springs alone, all that Jolt has, are a solid of 1/4 "
                      "(allowed: 0.25; for others --to bullet or mujoco, or --to springs for code of one's "
                      "own)",
                      what, ratio));
  };
  require_quarter("--poisson-ratio", springs.material->poisson_ratio);
  for (const SpringsRegion& region : springs.regions)
    require_quarter(fmt::format("region: '{}': poisson_ratio", region.name), region.material.poisson_ratio);
}

/// A document whose arrays are added by name.
struct EngineDocument : SpringsDocument {
  template <class T>
  void array(const std::string& table, const std::string& key, std::vector<T> values, std::size_t columns = 1) {
    const std::string name = table + "." + key;
    head[table][key] = "npy:" + name;
    const std::size_t rows = values.size() / columns;
    arrays.push_back({name, columns == 1 ? std::vector{rows} : std::vector{rows, columns}, std::move(values)});
  }

  template <class Rows>
  void nodes(const std::string& table, const std::string& key, const Rows& rows) {
    constexpr std::size_t columns = std::tuple_size_v<typename Rows::value_type>;
    std::vector<std::int32_t> flat;
    for (const auto& row : rows) flat.insert(flat.end(), row.begin(), row.end());
    array(table, key, std::move(flat), columns);
  }
};

/// Every name of a patch with its nodes.
void add_patches(const std::string& table, const std::vector<std::string>& names, const SpringsFile& springs,
                 EngineDocument& out) {
  out.head[table] = OrderedJson::object();
  for (const std::string& name : names) {
    const std::vector<int>& nodes = springs.patches.at(name);
    out.array(table, name, std::vector<std::int32_t>(nodes.begin(), nodes.end()));
  }
}

std::vector<std::array<int, 3>> surface_of(const NodalVectors& X, const std::vector<Tetrahedron>& tetrahedra) {
  Mesh mesh;
  mesh.nodes = X;
  mesh.tetrahedra = tetrahedra;
  std::vector<std::array<int, 3>> facets;
  for (const OuterFacet& f : outer_facets(mesh)) facets.push_back({f.nodes[0], f.nodes[1], f.nodes[2]});
  return facets;
}

OrderedJson head_of(const SpringsFile& springs, const std::string& format, const std::string& model,
                    double own_poisson_ratio, double safe_step) {
  const IsotropicMaterial& m = *springs.material;
  return {{"format", "springproof " + format},
          {"version", 1},
          {"origin",
           {{"program", springs.origin.program},
            {"input", springs.origin.input},
            {"checksum_xxh3_128", springs.origin.checksum}}},
          {"units", "m, kg, s, N, Pa"},
          {"model", model},
          {"material",
           {{"youngs_modulus_Pa", m.youngs_modulus}, {"poisson_ratio", m.poisson_ratio}, {"density_kg_m3", m.density}}},
          {"poisson_ratio_of_model", own_poisson_ratio},
          {"safe_time_step_s", safe_step}};
}

void add_body(const SpringsFile& body, const std::vector<std::string>& pinned, const std::vector<Spring>& springs,
              EngineDocument& out) {
  const Network& network = body.model.network;
  const Eigen::VectorXd mass = masses(network, body.density);
  out.array("nodes", "position_m", std::vector<double>(network.X.data(), network.X.data() + network.X.size()), 3);
  out.array("nodes", "mass_kg", std::vector<double>(mass.begin(), mass.end()));
  std::vector<std::array<int, 2>> ends;
  std::vector<double> length, stiffness, compliance;
  for (const Spring& s : springs) {
    ends.push_back({s.i, s.j});
    length.push_back(s.rest_length);
    stiffness.push_back(s.stiffness);
    compliance.push_back(1 / s.stiffness);
  }
  out.nodes("edges", "nodes", ends);
  out.array("edges", "rest_length_m", std::move(length));
  out.array("edges", "stiffness_N_m", std::move(stiffness));
  out.array("edges", "compliance_m_N", std::move(compliance));
  const std::vector<Tetrahedron> tetrahedra = five_tetrahedra(network.X, network.cells.corners, network.cells.edge);
  out.nodes("tetrahedra", "nodes", tetrahedra);
  out.nodes("surface", "facets", surface_of(network.X, tetrahedra));
  out.nodes("cells", "nodes", network.cells.corners);
  out.head["cells"]["edge_m"] = network.cells.edge;
  add_patches("pins", pinned, body, out);
  std::vector<std::string> all;
  for (const auto& [name, nodes] : body.patches) all.push_back(name);
  add_patches("patches", all, body, out);
}

/// The smallest step that single precision allows in this body, by gravity.
double least_step(const SpringsFile& springs) {
  return least_single_precision_step(springs.model.network.X.rowwise().norm().maxCoeff(), standard_gravity);
}

}  // namespace

std::string jolt_json(const SpringsFile& springs, const std::vector<std::string>& pinned) {
  require_springs_alone(springs);
  require_cubes(springs, "Jolt");
  const double safe = springs.derived.at("safe_time_step_s");
  EngineDocument out{{head_of(springs, "jolt", springs.origin.model, 0.25, safe), {}}};
  out.head["substeps"] = {
      {"least_s", least_step(springs)},
      {"most_s", largest_sweep_step(safe)},
      {"why",
       "length of one of Jolt's iterations, which are substeps: below the least, single precision no longer adds g h^2 "
       "to the farthest coordinate; above the most, one sweep over the springs leaves the body more than 2 % too "
       "soft"}};
  out.head["engine"] = {{"linear_damping", 0},
                        {"default_linear_damping", 0.1},
                        {"update_position", false},
                        {"make_rotation_identity", true},
                        {"volume_constraints", "none: of tetrahedra, they lock"}};
  add_body(springs, pinned, springs.model.network.springs, out);
  return as_json(out);
}

std::string bullet_json(const SpringsFile& springs, const std::vector<std::string>& pinned) {
  require_cubes(springs, "Bullet");
  const IsotropicMaterial& m = *springs.material;
  const BulletNeoHooke neo_hooke = bullet_neo_hooke(m);
  const double safe = safe_time_step_of_tetrahedra(m, springs.model.network.cells.edge);
  EngineDocument out{{head_of(springs, "bullet", "linear tetrahedra", m.poisson_ratio, safe), {}}};
  out.head["substeps"] = {
      {"least_s", least_step(springs)},
      {"most_s", slowest_frame},
      {"why",
       "implicit, whose stiffness no step changes but whose damping is pi f dt: below the least, single precision no "
       "longer adds g h^2 to the farthest coordinate; explicit steps end at safe_time_step_s"}};
  out.head["engine"] = {
      {"neo_hooke", {{"mu_Pa", neo_hooke.mu}, {"lambda_Pa", neo_hooke.lambda}}},
      {"linear", {{"youngs_modulus_Pa", m.youngs_modulus}, {"poisson_ratio", m.poisson_ratio}}},
      {"damping", {{"neo_hooke", 0}, {"linear_alpha_1_s", 0}, {"linear_beta_s", 0}}},
      {"default_damping", {{"neo_hooke", 0.05}, {"linear_alpha_1_s", 0.01}, {"linear_beta_s", 0.01}}}};
  add_body(springs, pinned, {}, out);
  return as_json(out);
}

std::string mujoco_mjcf(const SpringsFile& springs, const std::vector<std::string>& pinned) {
  require_cubes(springs, "MuJoCo");
  const Network& network = springs.model.network;
  const IsotropicMaterial& m = *springs.material;
  const double step = 1.0 / 240, edge = network.cells.edge;
  const Eigen::VectorXd mass = masses(network, springs.density);
  std::vector<char> fixed(network.nodes(), 0);
  for (const std::string& name : pinned)
    for (const int n : springs.patches.at(name)) fixed[n] = 1;
  std::string out = fmt::format(
      "<!-- {}, version 1, of {} (checksum {}): a solid of E = {:g} Pa, nu = {:g}, {:g} kg/m^3 in linear tetrahedra; "
      "m, "
      "kg, s.\n     integrator=\"discrete\" is implicit: its damping of a vibration of f Hz is pi f timestep of the "
      "critical.  For\n     integrator=\"Euler\", explicit: timestep up to {:.4g} s. -->\n",
      springs.origin.program, springs.origin.input, springs.origin.checksum, m.youngs_modulus, m.poisson_ratio,
      m.density, safe_time_step_of_tetrahedra(m, edge));
  const auto put = [&]<class... T>(fmt::format_string<T...> text, T&&... values) {
    fmt::format_to(std::back_inserter(out), text, std::forward<T>(values)...);
  };
  put("<mujoco model=\"springproof\">\n <option timestep=\"{}\" integrator=\"discrete\" gravity=\"0 0 -9.81\"/>\n"
      " <worldbody>\n  <body name=\"solid\">\n",
      step);
  for (int n = 0; n < network.nodes(); ++n) {
    put("   <body name=\"n{}\" pos=\"{} {} {}\"", n, network.X(n, 0), network.X(n, 1), network.X(n, 2));
    if (fixed[n]) {
      out += "/>\n";
      continue;
    }
    const double inertia = mass[n] * edge * edge / 6;  // does nothing: the body does not turn
    put("><inertial pos=\"0 0 0\" mass=\"{}\" diaginertia=\"{} {} {}\"/><joint type=\"slide\" axis=\"1 0 0\"/>"
        "<joint type=\"slide\" axis=\"0 1 0\"/><joint type=\"slide\" axis=\"0 0 1\"/></body>\n",
        mass[n], inertia, inertia, inertia);
  }
  out += "  </body>\n </worldbody>\n <deformable>\n  <flex name=\"solid\" dim=\"3\" body=\"";
  for (int n = 0; n < network.nodes(); ++n) put("{}n{}", n > 0 ? " " : "", n);
  out += "\"\n   element=\"";
  const char* space = "";
  for (const Tetrahedron& t : five_tetrahedra(network.X, network.cells.corners, edge)) {
    put("{}{} {} {} {}", space, t[0], t[1], t[2], t[3]);
    space = " ";
  }
  put("\" radius=\"{}\">\n   <elasticity young=\"{}\" poisson=\"{}\" damping=\"0\"/>\n   <contact "
      "selfcollide=\"none\" internal=\"false\"/>\n  </flex>\n </deformable>\n</mujoco>\n",
      edge / 100, m.youngs_modulus, m.poisson_ratio);
  return out;
}

}  // namespace springproof
