#include "comparisons/bench/engine_bar.h"

#include <Eigen/Geometry>
#include <cmath>
#include <stdexcept>

#include "msm/embedding/boundary.h"

namespace springproof::bench {
namespace {

const Vec3 bar_size(4, 1, 1), end_centre(4, 0.5, 0.5);

constexpr double end_torque = 300, end_pressure = 2000;  // [N m], [Pa]: 0.02 rad, strains of 0.002

}  // namespace

IsotropicMaterial bar_material(double poisson_ratio) { return {1e6, poisson_ratio, 1000}; }

EngineBar engine_bar(const Cells& cells) {
  if (cells[1] % 2 != 0 || cells[2] % 2 != 0) throw std::invalid_argument("the section needs an even number of cells");
  EngineBar bar{cells, block_mesh(bar_size, cells), {}, {}, {}};
  bar.mass = bar_material(0).density * nodal_volumes(bar.mesh);
  for (int n = 0; n < bar.mesh.nodes.rows(); ++n) {
    const Vec3 at = 2 * (bar.mesh.nodes.row(n).transpose() - end_centre);
    if (std::abs(at[0]) > 1e-9 || (at - at.array().round().matrix()).norm() > 1e-9) continue;
    bar.watched.push_back(n);
    bar.weights.push_back((at[1] == 0 ? 0.5 : 0.25) * (at[2] == 0 ? 0.5 : 0.25));
  }
  return bar;
}

std::vector<Load> loads_of(BarLoad load, bool held) {
  std::vector<Load> loads;
  if (held) loads.emplace_back(PrescribedDisplacement{"x_min", {0.0, 0.0, 0.0}});
  if (load == BarLoad::gravity) loads.emplace_back(Gravity{Vec3(0, 0, -bar_gravity), {}});
  if (load == BarLoad::torque)
    loads.emplace_back(Traction{"x_max", Vec3::Zero(), Wrench{Vec3::Zero(), Vec3(end_torque, 0, 0), end_centre}});
  if (load == BarLoad::pressure) loads.emplace_back(Pressure{"x_max", end_pressure, {}});
  return loads;
}

NodalVectors forces_of(BarLoad load, const EngineBar& bar) {
  return transfer(loads_of(load, false), bar.mesh, bar_material(0).density, Kinematics::linear).external;
}

double measure_of_face(BarLoad load, const NodalVectors& points, const NodalVectors& u,
                       const std::vector<double>& weights) {
  double mean = 0, turned = 0, second = 0;
  for (Eigen::Index i = 0; i < u.rows(); ++i) {
    const Vec3 r = points.row(i).transpose() - end_centre, v = u.row(i).transpose();
    mean -= weights[i] * v[2];
    turned += weights[i] * (r[1] * v[2] - r[2] * v[1]);
    second += weights[i] * (r[1] * r[1] + r[2] * r[2]);
  }
  return load == BarLoad::gravity ? mean : turned / second;
}

double measure_of(BarLoad load, const EngineBar& bar, const NodalVectors& u) {
  if (load != BarLoad::pressure) {
    NodalVectors points(bar.watched.size(), 3), there(bar.watched.size(), 3);
    for (std::size_t i = 0; i < bar.watched.size(); ++i) {
      points.row(i) = bar.mesh.nodes.row(bar.watched[i]);
      there.row(i) = u.row(bar.watched[i]);
    }
    return measure_of_face(load, points, there, bar.weights);
  }
  double flux = 0;
  for (const Patch& patch : bar.mesh.patches) {
    const int axis = patch.name[0] - 'x';
    flux += (patch.name.ends_with("max") ? 1 : -1) * nodal_areas(bar.mesh, patch).dot(u.col(axis));
  }
  return flux / bar_size.prod();
}

std::vector<TestField> test_fields(const EngineBar& bar, const IsotropicMaterial& m) {
  constexpr double e = 1e-3, curvature = 1e-3, twist = 1e-3;
  const double E = m.youngs_modulus, nu = m.poisson_ratio, G = shear_modulus(m), V = bar_size.prod(), L = bar_size[0];
  std::vector<TestField> fields;
  const auto add = [&](const char* name, double energy, const auto& at) {
    NodalVectors u(bar.mesh.nodes.rows(), 3);
    for (Eigen::Index n = 0; n < u.rows(); ++n)
      u.row(n) = at(Vec3(bar.mesh.nodes.row(n).transpose() - bar_size / 2)).transpose();
    fields.push_back({name, u, energy});
  };
  add("stretch", E * e * e * V / 2, [&](const Vec3& r) { return Vec3(e * Vec3(r[0], -nu * r[1], -nu * r[2])); });
  add("lateral", (lame_lambda(m) + 2 * G) * e * e * V / 2, [&](const Vec3& r) { return Vec3(0, e * r[1], 0); });
  add("shear", G * e * e * V / 2, [&](const Vec3& r) { return Vec3(e * r[2], 0, 0); });
  add("bending", E / 12 * curvature * curvature * L / 2, [&](const Vec3& r) {
    const double x = r[0], y = r[1], z = r[2];
    return Vec3(curvature * Vec3(-x * z, nu * y * z, x * x / 2 + nu * (z * z - y * y) / 2));
  });
  add("torsion", G / 6 * twist * twist * L / 2,
      [&](const Vec3& r) { return Vec3(twist * r[0] * Vec3(0, -r[2], r[1])); });
  add("hydrostatic", 4.5 * bulk_modulus(m) * e * e * V, [&](const Vec3& r) { return Vec3(e * r); });
  return fields;
}

NodalVectors bending_velocities(const EngineBar& bar, const Vec3& d, double tip_velocity) {
  const double b = 1.8751040687 / bar_size[0], s = 0.7340955;  // cos cosh = -1; (sinh - sin) / (cosh + cos)
  const auto shape = [&](double x) {
    return (std::cosh(b * x) - std::cos(b * x) - s * (std::sinh(b * x) - std::sin(b * x))) / 2;
  };
  const auto slope = [&](double x) {
    return b * (std::sinh(b * x) + std::sin(b * x) - s * (std::cosh(b * x) - std::cos(b * x))) / 2;
  };
  NodalVectors v(bar.mesh.nodes.rows(), 3);
  for (Eigen::Index n = 0; n < v.rows(); ++n) {
    const Vec3 r = bar.mesh.nodes.row(n).transpose() - Vec3(0, bar_size[1] / 2, bar_size[2] / 2);
    v.row(n) = tip_velocity * (shape(r[0]) * d - slope(r[0]) * r.dot(d) * Vec3::UnitX()).transpose();
  }
  return v;
}

NodalVectors spin_velocities(const EngineBar& bar, double rate) {
  NodalVectors v(bar.mesh.nodes.rows(), 3);
  for (Eigen::Index n = 0; n < v.rows(); ++n)
    v.row(n) = (rate * Vec3::UnitZ()).cross(Vec3(bar.mesh.nodes.row(n).transpose() - bar_size / 2)).transpose();
  return v;
}

}  // namespace springproof::bench
