#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <set>

#include "comparisons/calculix/deck.h"
#include "problem/case_file/measures.h"

namespace springproof::calculix {
namespace {

constexpr const char* to_1e8 =
    "** Equilibrium to 1e-8 of the mean force, not CalculiX' 0.5 %\n*CONTROLS, PARAMETERS=FIELD\n1e-8, 1e-5\n";

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

/// @param of_course ", AMPLITUDE=COURSE" of what follows a course in time
void write_supports(const Deck& deck, double factor, std::ostream& out, const char* of_course = "") {
  fmt::print(out, "** Prescribed displacements: node, component, component, value [m]\n*BOUNDARY{}\n", of_course);
  const Kinematics kinematics = deck.experiment.model_kinematics();
  for (const HeldComponent& h : deck.held) {
    const PrescribedValue u =
        prescribed_displacement(deck.experiment.loads[h.load], deck.mesh.nodes.row(h.node), kinematics, factor);
    fmt::print(out, "{}, {}, {}, {:.12g}\n", h.node + 1, h.component + 1, h.component + 1, *u[h.component]);
  }
}

void write_loads(const Deck& deck, double factor, std::ostream& out, const char* of_course = "") {
  if (!deck.forces.isZero(0))
    fmt::print(out, "** Distributed and point forces as nodal forces: node, component, force [N]\n*CLOAD{}\n",
               of_course);
  for (Eigen::Index n = 0; n < deck.forces.rows(); ++n)
    for (int c = 0; c < 3; ++c)
      if (deck.forces(n, c) != 0) fmt::print(out, "{}, {}, {:.12g}\n", n + 1, c + 1, factor * deck.forces(n, c));
  if (const double size = deck.gravity.norm(); size > 0)
    fmt::print(out, "** Gravity: size [m/s^2], direction\n*DLOAD{}\nBODY, GRAV, {:.12g}, {:.12g}, {:.12g}, {:.12g}\n",
               of_course, factor * size, deck.gravity.x() / size, deck.gravity.y() / size, deck.gravity.z() / size);
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
  if (finite) fmt::print(out, "0.25, 1., 1e-4, 0.25\n{}", to_1e8);
  const double factor = double(step) / deck.steps;
  write_supports(deck, factor, out);
  write_loads(deck, factor, out);
  if (step == deck.steps) write_requests(deck, out);
  fmt::print(out, "*END STEP\n");
}

/// The factor of the loads at the end of every step, of a released body from 1 to 0.
void write_course(const Deck& deck, std::ostream& out) {
  const MotionChoice& motion = *deck.experiment.dynamics;
  const double dt = motion.duration / deck.task.steps;
  fmt::print(out, "** Factor of the loads: time [s], factor\n*AMPLITUDE, NAME=COURSE\n");
  for (int i = 0; i <= deck.task.steps; ++i) {
    const double factor = motion.course.factor(i * dt);
    fmt::print(out, "{:.12g}, {:.12g}\n", i * dt, motion.released ? 1 - factor : factor);
  }
}

void write_velocities(const Deck& deck, std::ostream& out) {
  const MotionChoice& motion = *deck.experiment.dynamics;
  if (motion.velocity.isZero(0) && motion.spin.isZero(0)) return;
  fmt::print(out, "** Velocities at the start: node, component, velocity [m/s]\n*INITIAL CONDITIONS, TYPE=VELOCITY\n");
  for (Eigen::Index n = 0; n < deck.mesh.nodes.rows(); ++n) {
    const Vec3 arm = deck.mesh.nodes.row(n).transpose() - deck.centre, v = motion.velocity + motion.spin.cross(arm);
    for (int c = 0; c < 3; ++c) fmt::print(out, "{}, {}, {:.12g}\n", n + 1, c + 1, v[c]);
  }
}

/// The trapezoidal rule, without numerical damping.
void write_motion(const Deck& deck, std::ostream& out) {
  const MotionChoice& motion = *deck.experiment.dynamics;
  const bool finite = counterpart(deck.experiment).finite;
  const char* const nlgeom = finite ? ", NLGEOM, INC=1000000" : ", INC=1000000";
  std::set<int> nodes;
  for (Eigen::Index p = 0; p < deck.at_probes.rows(); ++p)
    for (NodalWeights::InnerIterator w(deck.at_probes, p); w; ++w) nodes.insert(static_cast<int>(w.col()));
  fmt::print(out, "**\n** Nodes of the elements that have a probe\n*NSET, NSET=AT_PROBES\n");
  write_numbers({nodes.begin(), nodes.end()}, out);
  const char* const print = "*NODE PRINT, NSET=AT_PROBES, FREQUENCY=1\nU\n";
  const char* const energy = finite ? "** ccx steps at finite strain only where energies are asked for\n"
                                      "*EL PRINT, ELSET=BODY, TOTALS=ONLY, FREQUENCY=1\nELSE\n"
                                    : "";
  write_course(deck, out);
  write_velocities(deck, out);
  if (motion.released) {
    fmt::print(out, "**\n*STEP{}\n*STATIC\n{}{}", nlgeom, finite ? "0.25, 1., 1e-4, 0.25\n" : "", finite ? to_1e8 : "");
    write_supports(deck, 1, out);
    write_loads(deck, 1, out);
    fmt::print(out, "{}{}*END STEP\n", print, energy);
  }
  fmt::print(out, "**\n*STEP{}\n*DYNAMIC, DIRECT, ALPHA=0.\n{:.12g}, {:.12g}\n{}", nlgeom,
             motion.duration / deck.task.steps, motion.duration, finite ? to_1e8 : "");
  if (!motion.released) write_supports(deck, 1, out, ", AMPLITUDE=COURSE");
  write_loads(deck, 1, out, ", AMPLITUDE=COURSE");
  fmt::print(out, "{}{}*END STEP\n", print, energy);
}

void write_frequencies(const Deck& deck, std::ostream& out) {
  fmt::print(out, "**\n** Supports at rest: node, component, component\n*BOUNDARY\n");
  for (const HeldComponent& h : deck.held)
    fmt::print(out, "{}, {}, {}\n", h.node + 1, h.component + 1, h.component + 1);
  fmt::print(out, "*STEP\n*FREQUENCY\n{}\n*NODE FILE\nU\n*END STEP\n", deck.task.modes);
}

}  // namespace

void write(const Deck& deck, std::ostream& out) {
  write_heading(deck, out);
  write_mesh(deck, out);
  write_sets(deck, out);
  write_probe_sets(deck, out);
  write_material(deck, out);
  if (deck.task.modes > 0) return write_frequencies(deck, out);
  if (deck.task.steps > 0) return write_motion(deck, out);
  for (int step = 1; step <= deck.steps; ++step) write_step(deck, step, out);
}

}  // namespace springproof::calculix
