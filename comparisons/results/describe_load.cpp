// Loads as sentences with units.
#include <fmt/format.h>

#include <numbers>

#include "comparisons/results/records.h"

namespace springproof {

std::string text(double x, Units units, const char* si, int digits) {
  const Named unit = unit_in(units, si);
  return fmt::format("{:.{}g} {}", x / unit.in_si, digits, unit.name);
}

static std::string text(const Vec3& v, int digits = 6) {
  return fmt::format("({:.{}g}, {:.{}g}, {:.{}g})", v.x(), digits, v.y(), digits, v.z(), digits);
}

std::string text(const Vec3& v, Units units, const char* si, int digits) {
  const Named unit = unit_in(units, si);
  return fmt::format("{} {}", text(Vec3(v / unit.in_si), digits), unit.name);
}

namespace {

std::string components(const std::vector<std::string>& axes) {
  if (axes.size() < 2) return axes.empty() ? "" : axes[0];
  const std::vector<std::string> head(axes.begin(), axes.end() - 1);
  return fmt::format("{} and {}", fmt::join(head, ", "), axes.back());
}

std::string sentence(const PrescribedDisplacement& load, Units units, Kinematics) {
  std::vector<std::string> held, moved, free;
  for (int c = 0; c < 3; ++c) {
    const std::string axis(1, "xyz"[c]);
    const auto& u = load.displacement[c];
    if (!u) {
      free.push_back(axis);
    } else if (*u == 0) {
      held.push_back(axis);
    } else {
      moved.push_back(fmt::format("by {} in {}", text(*u, units, "m"), axis));
    }
  }
  std::vector<std::string> parts;
  if (!moved.empty()) parts.push_back("moved " + components(moved));
  if (held.size() == 3) {
    parts.push_back("held");
  } else if (!held.empty()) {
    parts.push_back("held in " + components(held));
  }
  if (!free.empty()) parts.push_back("free in " + components(free));
  return fmt::format("{}: {}", load.on, fmt::join(parts, ", "));
}

std::string sentence(const PrescribedAffine& load, Units units, Kinematics) {
  const auto& A = load.gradient;
  return fmt::format("{}: moved by u = A X + b with the rows of A {} {} {} and b = {}", load.on,
                     text(A.row(0).transpose()), text(A.row(1).transpose()), text(A.row(2).transpose()),
                     text(load.offset, units, "m"));
}

std::string sentence(const PrescribedRotation& load, Units units, Kinematics) {
  return fmt::format("{}: turned by {:.6g} degrees about the axis {} through {}", load.on,
                     load.angle * 180 / std::numbers::pi, text(load.axis), text(load.point, units, "m"));
}

std::string sentence(const PrescribedField& load, Units, Kinematics) {
  return fmt::format("{}: moved by the exact field '{}'", load.on, load.field);
}

std::string sentence(const FieldBodyForce& load, Units, Kinematics) {
  return fmt::format("whole body: the body force of the exact field '{}'", load.field);
}

std::string sentence(const Pressure& load, Units units, Kinematics kinematics) {
  return fmt::format(
      "{}: pressed by {}{}", load.on, text(load.pressure, units, "Pa"),
      kinematics == Kinematics::linear ? "" : ", a dead load: per area at rest, against the outward normals at rest");
}

std::string sentence(const Traction& load, Units units, Kinematics) {
  return fmt::format("{}: loaded by a traction of {}", load.on, text(load.traction, units, "Pa"));
}

std::string sentence(const PatchForce& load, Units, Kinematics) {
  return fmt::format("{}: loaded by a total force of {} N", load.on, text(load.force));
}

std::string sentence(const Gravity& load, Units units, Kinematics) {
  return fmt::format("whole body: gravity of {}", text(load.acceleration, units, "m/s²"));
}

std::string sentence(const PointForce& load, Units units, Kinematics) {
  return fmt::format("point {}: loaded by a force of {} N", text(load.at, units, "m"), text(load.force));
}

LoadMark mark_of(const PrescribedDisplacement& load) {
  Vec3 u = Vec3::Zero();
  for (int c = 0; c < 3; ++c) u[c] = load.displacement[c].value_or(0);
  return {u.isZero(0) ? "held" : "moved", load.on, u};
}
LoadMark mark_of(const PrescribedAffine& load) { return {"moved", load.on}; }
LoadMark mark_of(const PrescribedRotation& load) { return {"turned", load.on, load.angle * load.axis, load.point}; }
LoadMark mark_of(const PrescribedField& load) { return {"moved", load.on}; }
LoadMark mark_of(const FieldBodyForce&) { return {}; }
LoadMark mark_of(const Pressure& load) { return {"pressure", load.on, {load.pressure, 0, 0}}; }
LoadMark mark_of(const Traction& load) { return {"force", load.on, load.traction}; }
LoadMark mark_of(const PatchForce& load) { return {"force", load.on, load.force}; }
LoadMark mark_of(const Gravity& load) { return {"gravity", "", load.acceleration}; }
LoadMark mark_of(const PointForce& load) { return {"point", "", load.force, load.at}; }

}  // namespace

LoadMark mark(const Load& load) {
  return std::visit([](const auto& l) { return mark_of(l); }, load);
}

std::string describe(const Load& load, Kinematics kinematics, Units units) {
  return std::visit([&](const auto& l) { return sentence(l, units, kinematics); }, load);
}

std::string describe(const AttachedMass& mass, Units units) {
  std::string where = "spread over " + mass.on;
  if (mass.at.size() == 1) where = "at " + text(mass.at[0], units, "m");
  if (mass.at.size() == 2)
    where = fmt::format("along the segment from {} to {}", text(mass.at[0], units, "m"), text(mass.at[1], units, "m"));
  const Named kg = unit_in(units, "kg");
  return fmt::format("{}: {:.6g} {} {}{}", mass.name, mass.mass / kg.in_si, kg.name, where,
                     mass.weighs ? "" : ", without weight");
}

}  // namespace springproof
