#include "comparisons/calculix/deck.h"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "problem/case_file/measures.h"
#include "problem/exact_field.h"

namespace springproof::calculix {
namespace {

constexpr double largest_turn_per_step = 20 * std::numbers::pi / 180;

/// A law of the case files, and its form in a deck.
struct Counterpart {
  const char* kinematics;
  bool finite;
  const char* remark;
  void (*write)(const IsotropicMaterial&, std::ostream&);
};

void write_elastic(const IsotropicMaterial& m, std::ostream& out) {
  fmt::print(out, "** Young's modulus [Pa], Poisson's ratio\n*ELASTIC\n{:.12g}, {:.12g}\n", m.youngs_modulus,
             m.poisson_ratio);
}

void write_neo_hooke(const IsotropicMaterial& m, std::ostream& out) {
  fmt::print(out, "** C10 = mu / 2 [Pa], D1 = 2 / K [1/Pa]\n*HYPERELASTIC, NEO HOOKE\n{:.12g}, {:.12g}\n",
             shear_modulus(m) / 2, 2 / bulk_modulus(m));
}

constexpr Counterpart counterparts[] = {
    {"linear", false, "small displacements, Hooke's law", write_elastic},
    {"neo_hooke_isochoric", true, "W = C10 (J^(-2/3) tr C - 3) + (J - 1)^2 / D1", write_neo_hooke},
    {"st_venant_kirchhoff", true, "S = 2 mu E + lambda tr E I (*ELASTIC with NLGEOM in CalculiX)", write_elastic}};

const Counterpart& counterpart(const Experiment& experiment) {
  for (const Counterpart& c : counterparts)
    if (experiment.kinematics == c.kinematics) return c;
  throw InputError(SourceLocation{experiment.file.string(), 0, 0},
                   fmt::format("kinematics: CalculiX has no \"{}\" (there: {})", experiment.kinematics,
                               kinematics_with_counterpart()));
}

const QuadraticPatch& patch_of(const QuadraticMesh& mesh, const std::string& name) {
  const auto at = std::find_if(mesh.patches.begin(), mesh.patches.end(), [&](const auto& p) { return p.name == name; });
  if (at != mesh.patches.end()) return *at;
  std::vector<std::string> names;
  for (const QuadraticPatch& p : mesh.patches) names.push_back(p.name);
  throw InputError(fmt::format("on: no patch '{}' on this body (there: {})", name, fmt::join(names, ", ")));
}

std::vector<HeldComponent> held_components(const Experiment& experiment, const QuadraticMesh& mesh) {
  std::map<std::pair<int, int>, int> owner;  // by node and component
  for (std::size_t l = 0; l < experiment.loads.size(); ++l) {
    const Load& load = experiment.loads[l];
    if (!prescribes_displacement(load)) continue;
    for (const int node : patch_of(mesh, *patch_of(load)).nodes) {
      const PrescribedValue u = prescribed_displacement(load, mesh.nodes.row(node), experiment.model_kinematics());
      for (int c = 0; c < 3; ++c)
        if (u[c]) owner.try_emplace({node, c}, int(l));
    }
  }
  std::vector<HeldComponent> held;
  for (const auto& [key, load] : owner) held.push_back({key.first, key.second, load});
  return held;
}

/// Everything but gravity as concentrated loads.
NodalVectors concentrated(const Experiment& experiment, const IsotropicMaterial& material, const Mesh& linear,
                          const QuadraticMesh& mesh) {
  NodalVectors forces = NodalVectors::Zero(mesh.nodes.rows(), 3);
  for (const Load& load : experiment.loads) {
    if (const auto* t = std::get_if<Traction>(&load))
      forces += nodal_areas(mesh, patch_of(mesh, t->on)) * t->traction.transpose();
    if (const auto* p = std::get_if<Pressure>(&load))
      forces += p->pressure * nodal_area_vectors(mesh, patch_of(mesh, p->on));
    if (const auto* b = std::get_if<FieldBodyForce>(&load))
      forces += nodal_body_forces(mesh, [&](const Vec3& X) { return exact_body_force(b->field, X, material); });
    if (const auto* f = std::get_if<PatchForce>(&load)) {
      const Eigen::VectorXd areas = nodal_areas(mesh, patch_of(mesh, f->on));
      forces += areas / areas.sum() * f->force.transpose();
    }
    if (const auto* p = std::get_if<PointForce>(&load))
      for (const auto& [node, weight] : weights_at(mesh, linear, p->at)) forces.row(node) += weight * p->force;
  }
  return forces;
}

int steps_for(const Experiment& experiment) {
  int steps = 1;
  if (experiment.model_kinematics() == Kinematics::linear) return steps;
  for (const Load& load : experiment.loads)
    if (const auto* turn = std::get_if<PrescribedRotation>(&load))
      steps = std::max(steps, static_cast<int>(std::ceil(std::abs(turn->angle) / largest_turn_per_step - 1e-9)));
  return steps;
}

/// "z_max" -> "Z_MAX": a label that CalculiX and Abaqus accept and print unchanged.
std::string label(const std::string& name) {
  std::string out;
  for (const char c : name) out += std::isalnum(static_cast<unsigned char>(c)) ? char(std::toupper(c)) : '_';
  return out;
}

void check_labels(const Experiment& experiment, const QuadraticMesh& mesh) {
  std::set<std::string> seen = {"ALL_NODES", "HELD_NODES", "BODY", "IN_NO_REGION"};
  const auto check = [&](const std::string& name, const std::string& set) {
    if (!seen.insert(set).second || set.size() > 70)
      throw InputError(
          fmt::format("{}: '{}' cannot name a set of the deck: {} is taken or too long", experiment.name, name, set));
  };
  for (const QuadraticPatch& p : mesh.patches) check(p.name, label(p.name));
  for (const Probe& p : experiment.probes) check(p.name, "PROBE_" + label(p.name));
  for (const MaterialRegion& r : experiment.regions) check(r.name, "REGION_" + label(r.name));
}

/// A part of the body and its section.
struct Section {
  std::string set, name;  ///< the latter of the material
  IsotropicMaterial material;
  std::vector<int> elements;
};

std::vector<Section> sections_of(const Deck& deck) {
  std::vector<Section> sections = {{"BODY", "SOLID", deck.material, {}}};
  if (deck.linear.materials.empty()) return sections;
  sections[0].set = "IN_NO_REGION";
  for (const MaterialRegion& r : deck.experiment.regions)
    sections.push_back({"REGION_" + label(r.name), "OF_" + label(r.name), r.material, {}});
  for (std::size_t e = 0; e < deck.linear.materials.size(); ++e)
    sections[deck.linear.materials[e]].elements.push_back(static_cast<int>(e));
  std::erase_if(sections, [](const Section& s) { return s.elements.empty(); });
  return sections;
}

std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 32; }, ' ');
  return text;
}

void write_numbers(const std::vector<int>& numbers, std::ostream& out) {
  for (std::size_t i = 0; i < numbers.size(); i += 12) {
    std::vector<int> line(numbers.begin() + i, numbers.begin() + std::min(i + 12, numbers.size()));
    for (int& n : line) ++n;
    fmt::print(out, "{}{}\n", fmt::join(line, ", "), i + 12 < numbers.size() ? "," : "");
  }
}

void write_heading(const Deck& deck, std::ostream& out) {
  const Experiment& e = deck.experiment;
  fmt::print(out, "*HEADING\n{}, nu = {:.6g} (written by springproof)\n", one_line(e.name),
             deck.material.poisson_ratio);
  for (const std::string& text : {e.what, e.cite})
    if (!text.empty()) fmt::print(out, "** {}\n", one_line(text));
  fmt::print(out, "** kinematics = {}: {}\n", e.kinematics, counterpart(e).remark);
  fmt::print(out, "** SI units: m, kg, s, N, Pa.  {} nodes, {} elements {}.\n", deck.mesh.nodes.rows(),
             deck.mesh.elements.size(), deck.element);
  fmt::print(out,
             "** To run:  ccx -i NAME   (for NAME.inp; use a direct solver such as SPOOLES, ccx' default: "
             "its iterative\n"
             "** ones stop too early for reactions)\n");
}

void write_mesh(const Deck& deck, std::ostream& out) {
  const QuadraticMesh& mesh = deck.mesh;
  fmt::print(out, "**\n** Corner nodes first, then the middles of the edges [m]\n*NODE, NSET=ALL_NODES\n");
  for (Eigen::Index n = 0; n < mesh.nodes.rows(); ++n)
    fmt::print(out, "{}, {:.12g}, {:.12g}, {:.12g}\n", n + 1, mesh.nodes(n, 0), mesh.nodes(n, 1), mesh.nodes(n, 2));
  std::size_t before = 0;
  for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
    const std::vector<int>& element = mesh.elements[e];
    if (element.size() != before)
      fmt::print(out, "*ELEMENT, TYPE={}, ELSET=BODY\n", element.size() == 20 ? deck.element : "C3D10");
    before = element.size();
    std::vector<int> numbers = {static_cast<int>(e)};
    numbers.insert(numbers.end(), element.begin(), element.end());
    write_numbers(numbers, out);
  }
}

void write_sets(const Deck& deck, std::ostream& out) {
  for (const QuadraticPatch& p : deck.mesh.patches) {
    if (p.sides.empty()) continue;
    fmt::print(out, "**\n** Patch {}\n*NSET, NSET={}\n", one_line(p.name), label(p.name));
    write_numbers(p.nodes, out);
    fmt::print(out, "*SURFACE, NAME={}, TYPE=ELEMENT\n", label(p.name));
    for (const Side& side : p.sides) fmt::print(out, "{}, S{}\n", side.element + 1, side.face);
  }
  std::vector<int> held;
  for (const HeldComponent& h : deck.held)
    if (held.empty() || held.back() != h.node) held.push_back(h.node);
  fmt::print(out, "**\n** Nodes with a prescribed displacement\n*NSET, NSET=HELD_NODES\n");
  write_numbers(held, out);
}

/// The node at a rest position, if there is one.
std::vector<int> node_at(const Deck& deck, const Vec3& point) {
  Eigen::Index nearest = 0;
  const double distance = (deck.mesh.nodes.rowwise() - point.transpose()).rowwise().norm().minCoeff(&nearest);
  const double size = (deck.mesh.nodes.colwise().maxCoeff() - deck.mesh.nodes.colwise().minCoeff()).norm();
  return distance <= 1e-9 * size ? std::vector<int>{int(nearest)} : std::vector<int>{};
}

void write_probe_sets(const Deck& deck, std::ostream& out) {
  for (const Probe& p : deck.experiment.probes) {
    const std::vector<int> node = node_at(deck, p.at);
    fmt::print(out, "**\n** Probe {} at ({:.6g}, {:.6g}, {:.6g}) m{}\n", one_line(p.name), p.at.x(), p.at.y(), p.at.z(),
               node.empty() ? ": no node there" : "");
    if (!node.empty()) fmt::print(out, "*NSET, NSET=PROBE_{}\n{}\n", label(p.name), node.front() + 1);
  }
}

void write_material(const Deck& deck, std::ostream& out) {
  for (const Section& section : sections_of(deck)) {
    fmt::print(out, "**\n");
    if (!section.elements.empty()) {
      fmt::print(out, "*ELSET, ELSET={}\n", section.set);
      write_numbers(section.elements, out);
    }
    fmt::print(out, "*MATERIAL, NAME={}\n", section.name);
    counterpart(deck.experiment).write(section.material, out);
    fmt::print(out, "*DENSITY\n{:.12g}\n*SOLID SECTION, ELSET={}, MATERIAL={}\n", section.material.density, section.set,
               section.name);
  }
}

void write_supports(const Deck& deck, double factor, std::ostream& out) {
  fmt::print(out, "** Prescribed displacements: node, component, component, value [m]\n*BOUNDARY\n");
  const Kinematics kinematics = deck.experiment.model_kinematics();
  for (const HeldComponent& h : deck.held) {
    const PrescribedValue u =
        prescribed_displacement(deck.experiment.loads[h.load], deck.mesh.nodes.row(h.node), kinematics, factor);
    fmt::print(out, "{}, {}, {}, {:.12g}\n", h.node + 1, h.component + 1, h.component + 1, *u[h.component]);
  }
}

void write_loads(const Deck& deck, double factor, std::ostream& out) {
  if (!deck.forces.isZero(0))
    fmt::print(out, "** Distributed and point forces as nodal forces: node, component, force [N]\n*CLOAD\n");
  for (Eigen::Index n = 0; n < deck.forces.rows(); ++n)
    for (int c = 0; c < 3; ++c)
      if (deck.forces(n, c) != 0) fmt::print(out, "{}, {}, {:.12g}\n", n + 1, c + 1, factor * deck.forces(n, c));
  if (const double size = deck.gravity.norm(); size > 0)
    fmt::print(out, "** Gravity: size [m/s^2], direction\n*DLOAD\nBODY, GRAV, {:.12g}, {:.12g}, {:.12g}, {:.12g}\n",
               factor * size, deck.gravity.x() / size, deck.gravity.y() / size, deck.gravity.z() / size);
}

void write_requests(const Deck& deck, std::ostream& out) {
  fmt::print(out, "** For cgx\n*NODE FILE, FREQUENCY=9999\nU, RF\n*EL FILE, FREQUENCY=9999\nS, E\n");
  fmt::print(out, "** Seven digits, into the .dat file.  RF is the support force plus the loads on those nodes.\n");
  for (const std::string& name : supported_patches(deck.experiment))
    fmt::print(out, "*NODE PRINT, NSET={}, TOTALS=ONLY, FREQUENCY=9999\nRF\n", label(name));
  for (const Probe& p : deck.experiment.probes)
    if (!node_at(deck, p.at).empty()) fmt::print(out, "*NODE PRINT, NSET=PROBE_{}, FREQUENCY=9999\nU\n", label(p.name));
  fmt::print(out, "*NODE PRINT, NSET=HELD_NODES, FREQUENCY=9999\nRF\n*NODE PRINT, NSET=ALL_NODES, FREQUENCY=9999\nU\n");
}

void write_step(const Deck& deck, int step, std::ostream& out) {
  const bool finite = counterpart(deck.experiment).finite;
  fmt::print(out, "**\n*STEP{}\n*STATIC\n", finite ? ", NLGEOM, INC=1000" : "");
  if (finite)
    fmt::print(out,
               "0.25, 1., 1e-4, 0.25\n** Equilibrium to 1e-8 of the mean force, not CalculiX' 0.5 %\n"
               "*CONTROLS, PARAMETERS=FIELD\n1e-8, 1e-5\n");
  const double factor = double(step) / deck.steps;
  write_supports(deck, factor, out);
  write_loads(deck, factor, out);
  if (step == deck.steps) write_requests(deck, out);
  fmt::print(out, "*END STEP\n");
}

}  // namespace

std::string kinematics_with_counterpart() {
  std::vector<std::string> names;
  for (const Counterpart& c : counterparts) names.emplace_back(c.kinematics);
  return fmt::format("{}", fmt::join(names, ", "));
}

bool needs_reduced_integration(const Experiment& experiment, const IsotropicMaterial& material) {
  double largest = material.poisson_ratio;
  for (const MaterialRegion& r : experiment.regions) largest = std::max(largest, r.material.poisson_ratio);
  return largest > largest_ratio_full_integration;
}

void require_counterpart(const Experiment& experiment) { counterpart(experiment); }

Deck make_deck(const Experiment& experiment, const IsotropicMaterial& material, const Mesh& mesh) {
  require_counterpart(experiment);
  Deck deck{experiment, material, mesh, quadratic(mesh), {}, {}, {}, Vec3::Zero(), steps_for(experiment)};
  check_labels(experiment, deck.mesh);
  const bool locks = needs_reduced_integration(experiment, material);
  deck.element = mesh.hexahedra.empty() ? "C3D10" : locks ? "C3D20R" : "C3D20";
  deck.held = held_components(experiment, deck.mesh);
  deck.forces = concentrated(experiment, material, mesh, deck.mesh);
  for (const Load& load : experiment.loads)
    if (const auto* g = std::get_if<Gravity>(&load)) deck.gravity += g->acceleration;
  return deck;
}

void write(const Deck& deck, std::ostream& out) {
  write_heading(deck, out);
  write_mesh(deck, out);
  write_sets(deck, out);
  write_probe_sets(deck, out);
  write_material(deck, out);
  for (int step = 1; step <= deck.steps; ++step) write_step(deck, step, out);
}

NodalVectors external_loads(const Deck& deck) {
  NodalVectors forces = deck.forces;
  for (const Section& section : sections_of(deck)) {
    QuadraticMesh part{deck.mesh.nodes, {}, {}};
    for (const int e : section.elements) part.elements.push_back(deck.mesh.elements[e]);
    forces += section.material.density * nodal_volumes(section.elements.empty() ? deck.mesh : part) *
              deck.gravity.transpose();
  }
  return forces;
}

}  // namespace springproof::calculix
