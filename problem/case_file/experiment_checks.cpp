// Checks of a case as a whole.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "problem/case_file/experiment_parts.h"

namespace springproof {
namespace {

/// Whether a load keeps the displacement along an axis 0 and all displacements constant along it.
struct LeavesPlane {
  int axis;

  bool operator()(const PrescribedDisplacement& l) const { return l.displacement[axis].value_or(0) == 0; }
  bool operator()(const PrescribedAffine& l) const {
    return l.offset[axis] == 0 && l.gradient.row(axis).isZero(0) && l.gradient.col(axis).isZero(0);
  }
  bool operator()(const PrescribedRotation& l) const { return std::abs(std::abs(l.axis[axis]) - 1) < 1e-12; }
  bool operator()(const Traction& l) const { return l.traction[axis] == 0; }
  bool operator()(const PatchForce& l) const { return l.force[axis] == 0; }
  bool operator()(const Gravity& l) const { return l.acceleration[axis] == 0; }
  bool operator()(const Pressure&) const { return true; }
  template <class AnyOther>
  bool operator()(const AnyOther&) const {
    return false;
  }
};

/// Plane strain: both faces normal to the axis are fixed along it and otherwise free, and no load acts along it.
bool is_plane_strain(const std::vector<Load>& loads, int axis) {
  const std::string faces[] = {std::string(1, "xyz"[axis]) + "_min", std::string(1, "xyz"[axis]) + "_max"};
  int held = 0;
  for (const Load& load : loads) {
    if (!std::visit(LeavesPlane{axis}, load)) return false;
    const std::string* on = patch_of(load);
    if (!on || (*on != faces[0] && *on != faces[1])) continue;
    const auto* fixed = std::get_if<PrescribedDisplacement>(&load);
    if (!fixed) return false;
    for (int c = 0; c < 3; ++c)
      if (fixed->displacement[c].has_value() != (c == axis)) return false;
    held |= *on == faces[0] ? 1 : 2;
  }
  return held == 3;
}

/// Lower bound of the memory [byte] of the finest grid: matrix-free quadratic elements take 450 bytes per unknown.
double memory_for(const Cells& cells, const std::vector<std::string>& elements) {
  const bool quadratic = std::ranges::any_of(elements, [](const std::string& e) { return e.ends_with('2'); });
  double unknowns = 3;
  for (const int n : cells) unknowns *= (quadratic ? 2.0 : 1.0) * n + 1;
  return 450 * unknowns;
}

/// Components that a load prescribes.
std::array<bool, 3> held_by(const Load& load) {
  const PrescribedValue u = prescribed_displacement(load, Vec3::Zero(), Kinematics::linear, 1);
  return {u[0].has_value(), u[1].has_value(), u[2].has_value()};
}

/// Components of a traction or patch force; zero for other loads.
Vec3 pull_of(const Load& load) {
  if (const auto* t = std::get_if<Traction>(&load)) return t->traction;
  if (const auto* f = std::get_if<PatchForce>(&load)) return f->force;
  return Vec3::Zero();
}

/// Refuses two loads on one patch that contradict each other.
void check_pair(const Experiment& e, std::size_t i, std::size_t j) {
  const Load &first = e.loads[i], &second = e.loads[j];
  const std::string* patch = patch_of(first);
  if (!patch || !patch_of(second) || *patch != *patch_of(second)) return;
  const auto first_held = held_by(first), second_held = held_by(second);
  const auto *a = std::get_if<PrescribedDisplacement>(&first), *b = std::get_if<PrescribedDisplacement>(&second);
  const std::string other = fmt::format("the load in line {}", e.load_locations[i].line);
  for (int c = 0; c < 3; ++c) {
    const char axis = "xyz"[c];
    if (first_held[c] && second_held[c] && !(a && b && a->displacement[c] == b->displacement[c]))
      throw InputError(
          e.load_locations[j],
          fmt::format("load: the displacement of '{}' along {} is prescribed by {} too (allowed: by one load)", *patch,
                      axis, other));
    if ((first_held[c] && pull_of(second)[c] != 0) || (second_held[c] && pull_of(first)[c] != 0))
      throw InputError(e.load_locations[j],
                       fmt::format("load: '{}' is held and pulled along {}, here and by {}: the force would do nothing "
                                   "(allowed: \"free\" there, or no force)",
                                   *patch, axis, other));
  }
}

void check_contradictions(const Experiment& e) {
  for (std::size_t j = 0; j < e.loads.size(); ++j)
    for (std::size_t i = 0; i < j; ++i) check_pair(e, i, j);
}

/// The body force of an exact field is defined for small strains, and only the finite elements support it.
void check_body_forces(const Experiment& experiment) {
  for (std::size_t i = 0; i < experiment.loads.size(); ++i) {
    if (!std::holds_alternative<FieldBodyForce>(experiment.loads[i])) continue;
    const char* allowed = experiment.model_kinematics() == Kinematics::finite ? "under kinematics = \"linear\""
                          : experiment.models.empty()                         ? nullptr
                                                                              : "with [compare] models = []";
    if (allowed)
      throw InputError(experiment.load_locations[i],
                       fmt::format("load.body_force_of: cannot be applied here (allowed: {})", allowed));
  }
}

}  // namespace

void check_reference_cells(const TomlValue& value, const Experiment& e) {
  const TomlValue where{value.node->as_table()->get("cells"), value.key + ".cells", value.file};
  const Cells& cells = e.reference.cells;
  for (int axis = 0; axis < 3; ++axis) {
    const std::string is = fmt::format("is {} along {}", cells[axis], "xyz"[axis]);
    if (cells[axis] % 4 != 0 && cells[axis] != 1)
      refuse(where, is, "numbers divisible by 4, as the grid is halved twice");
    if (cells[axis] == 1 && !is_plane_strain(e.loads, axis))
      refuse(where, is + ", which cannot be refined",
             "numbers divisible by 4; 1 across plane strain, where both faces are held along the axis alone");
  }
  const double machine = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGE_SIZE)),
               needed = memory_for(cells, e.reference.elements);
  if (needed > machine)
    refuse(where, fmt::format("[{}] would take {:.3g} GB of memory", fmt::join(cells, ", "), needed / 1e9),
           fmt::format("what fits into the {:.3g} GB of this machine", machine / 1e9));
}

void check_loads(const Experiment& experiment) {
  check_body_forces(experiment);
  check_contradictions(experiment);
}

}  // namespace springproof
