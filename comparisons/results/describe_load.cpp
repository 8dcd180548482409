// Loads as sentences with units.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "comparisons/results/records.h"

namespace springproof {
namespace {

std::string text(const Vec3& v) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", v.x(), v.y(), v.z()); }

std::string components(const std::vector<std::string>& axes) {
  if (axes.size() < 2) return axes.empty() ? "" : axes[0];
  const std::vector<std::string> head(axes.begin(), axes.end() - 1);
  return fmt::format("{} and {}", fmt::join(head, ", "), axes.back());
}

std::string sentence(const PrescribedDisplacement& load) {
  std::vector<std::string> held, moved, free;
  for (int c = 0; c < 3; ++c) {
    const std::string axis(1, "xyz"[c]);
    const auto& u = load.displacement[c];
    if (!u) {
      free.push_back(axis);
    } else if (*u == 0) {
      held.push_back(axis);
    } else {
      moved.push_back(fmt::format("by {:.6g} m in {}", *u, axis));
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

std::string sentence(const PrescribedAffine& load) {
  const auto& A = load.gradient;
  return fmt::format("{}: moved by u = A X + b with the rows of A {} {} {} and b = {} m", load.on,
                     text(A.row(0).transpose()), text(A.row(1).transpose()), text(A.row(2).transpose()),
                     text(load.offset));
}

std::string sentence(const PrescribedRotation& load) {
  return fmt::format("{}: turned by {:.6g} degrees about the axis {} through {} m", load.on,
                     load.angle * 180 / std::numbers::pi, text(load.axis), text(load.point));
}

std::string sentence(const PrescribedField& load) {
  return fmt::format("{}: moved by the exact field '{}'", load.on, load.field);
}

std::string sentence(const FieldBodyForce& load) {
  return fmt::format("whole body: the body force of the exact field '{}'", load.field);
}

std::string sentence(const Pressure& load, Kinematics kinematics) {
  return fmt::format(
      "{}: pressed by {:.6g} Pa{}", load.on, load.pressure,
      kinematics == Kinematics::linear ? "" : ", a dead load: per area at rest, against the outward normals at rest");
}

std::string sentence(const Traction& load) {
  return fmt::format("{}: loaded by a traction of {} Pa", load.on, text(load.traction));
}

std::string sentence(const PatchForce& load) {
  return fmt::format("{}: loaded by a total force of {} N", load.on, text(load.force));
}

std::string sentence(const Gravity& load) {
  return fmt::format("whole body: gravity of {} m/s²", text(load.acceleration));
}

std::string sentence(const PointForce& load) {
  return fmt::format("point {} m: loaded by a force of {} N", text(load.at), text(load.force));
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

std::string describe(const Load& load, Kinematics kinematics) {
  return std::visit(
      [&](const auto& l) {
        if constexpr (std::is_same_v<std::decay_t<decltype(l)>, Pressure>)
          return sentence(l, kinematics);
        else
          return sentence(l);
      },
      load);
}

std::string describe(const AttachedMass& mass) {
  std::string where = "spread over " + mass.on;
  if (mass.at.size() == 1) where = fmt::format("at {} m", text(mass.at[0]));
  if (mass.at.size() == 2) where = fmt::format("along the segment from {} to {} m", text(mass.at[0]), text(mass.at[1]));
  return fmt::format("{}: {:.6g} kg {}{}", mass.name, mass.mass, where, mass.weighs ? "" : ", without weight");
}

}  // namespace springproof
