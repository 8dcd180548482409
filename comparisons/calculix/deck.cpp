
#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "comparisons/prepare/sampling.h"
#include "problem/case_file/measures.h"
#include "problem/exact_field.h"

namespace springproof::calculix {
namespace {

constexpr double largest_turn_per_step = 20 * std::numbers::pi / 180;

const QuadraticPatch& patch_of(const QuadraticMesh& mesh, const std::string& name) {
  const auto at = std::ranges::find_if(mesh.patches, [&](const auto& p) { return p.name == name; });
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

/// How far points of a curved body may lie outside a coarse mesh of it [m].
double reach_of(const Mesh& mesh) {
  return (mesh.nodes.colwise().maxCoeff() - mesh.nodes.colwise().minCoeff()).norm() / 100;
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
      forces += weights_at(mesh, linear, p->at.transpose(), reach_of(linear)).transpose() * p->force.transpose();
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

void check_labels(const Experiment& experiment, const QuadraticMesh& mesh) {
  std::set<std::string> seen = {"ALL_NODES", "HELD_NODES", "AT_PROBES", "BODY", "IN_NO_REGION"};
  const auto check = [&](const std::string& name, const std::string& set) {
    if (!seen.insert(set).second || set.size() > 70)
      throw InputError(
          fmt::format("{}: '{}' cannot name a set of the deck: {} is taken or too long", experiment.name, name, set));
  };
  for (const QuadraticPatch& p : mesh.patches) check(p.name, label(p.name));
  for (const Probe& p : experiment.probes) check(p.name, "PROBE_" + label(p.name));
  for (const MaterialRegion& r : experiment.regions) check(r.name, "REGION_" + label(r.name));
}

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

Eigen::VectorXd nodal_masses(const Deck& deck) {
  Eigen::VectorXd masses = Eigen::VectorXd::Zero(deck.mesh.nodes.rows());
  for (const Section& section : sections_of(deck)) {
    QuadraticMesh part{deck.mesh.nodes, {}, {}};
    for (const int e : section.elements) part.elements.push_back(deck.mesh.elements[e]);
    masses += section.material.density * nodal_volumes(section.elements.empty() ? deck.mesh : part);
  }
  return masses;
}

}  // namespace

void require_motion_counterpart(const Experiment& e) {
  const MotionChoice& motion = *e.dynamics;
  const auto none = [&](bool there, const char* what) {
    if (there) throw InputError(motion.where, fmt::format("dynamics: CalculiX' decks have no {}", what));
  };
  none(motion.damping > 0 || motion.viscosity > 0, "damping in steps of time (allowed: damping_1_s and viscosity_s 0)");
  none(e.relaxation.acts(), "relaxation");
  none(motion.plane.has_value(), "plane to fall on");
  none(!e.masses.empty(), "attached masses");
  none(e.probes.empty(), "history without a [[probe]]");
  const Course& course = motion.course;
  const double sample = motion.duration / motion.samples,
               shortest = course.frequency > 0 ? 1 / course.frequency : course.settled();
  none(shortest > 0 && shortest < 4 * sample, "loads that change within four samples (allowed: more samples)");
  for (const Load& load : e.loads) none(std::holds_alternative<PrescribedRotation>(load), "support that turns in time");
}

bool needs_reduced_integration(const Experiment& experiment, const IsotropicMaterial& material) {
  double largest = material.poisson_ratio;
  for (const MaterialRegion& r : experiment.regions) largest = std::max(largest, r.material.poisson_ratio);
  return largest > largest_ratio_full_integration;
}

const char* element_of(const Experiment& experiment, const IsotropicMaterial& material, const Mesh& mesh) {
  if (mesh.hexahedra.empty()) return "C3D10";
  return needs_reduced_integration(experiment, material) ? "C3D20R" : "C3D20";
}

Deck make_deck(const Experiment& experiment, const IsotropicMaterial& material, const Mesh& mesh, DeckTask task) {
  if (task.modes == 0) counterpart(experiment);
  Deck deck{experiment, material, mesh, quadratic(mesh), {}, {}, {}, Vec3::Zero(), steps_for(experiment), task, {}};
  check_labels(experiment, deck.mesh);
  deck.element = element_of(experiment, material, mesh);
  deck.held = held_components(experiment, deck.mesh);
  if (task.modes > 0) {
    deck.experiment.kinematics = "linear";
    return deck;
  }
  deck.forces = concentrated(experiment, material, mesh, deck.mesh);
  for (const Load& load : experiment.loads)
    if (const auto* g = std::get_if<Gravity>(&load)) deck.gravity += g->acceleration;
  if (task.steps == 0) return deck;
  deck.at_probes = weights_at(deck.mesh, mesh, probe_points(experiment), reach_of(mesh));
  const Eigen::VectorXd masses = nodal_masses(deck);
  deck.centre = deck.mesh.nodes.transpose() * masses / masses.sum();
  return deck;
}

NodalVectors external_loads(const Deck& deck) { return deck.forces + nodal_masses(deck) * deck.gravity.transpose(); }

const Counterpart& counterpart(const Experiment& experiment) {
  std::vector<std::string> there;
  for (const Counterpart& c : counterparts) {
    if (experiment.kinematics == c.kinematics) return c;
    there.emplace_back(c.kinematics);
  }
  throw InputError(
      SourceLocation{experiment.file.string(), 0, 0},
      fmt::format("kinematics: CalculiX has no \"{}\" (there: {})", experiment.kinematics, fmt::join(there, ", ")));
}

std::string label(const std::string& name) {
  std::string out;
  for (const char c : name) out += std::isalnum(static_cast<unsigned char>(c)) ? char(std::toupper(c)) : '_';
  return out;
}

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

}  // namespace springproof::calculix
