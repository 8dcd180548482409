#include "comparisons/engines/engine_constants.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "msm/algebra/dense.h"

namespace springproof {
namespace {

// Of a cube whose first corner is an even node of the lattice; of the others the mirror image x -> 1 - x.
constexpr std::array<Tetrahedron, 5> five_of_cube = {
    {{0, 2, 7, 5}, {1, 0, 5, 2}, {3, 0, 2, 7}, {4, 0, 7, 5}, {6, 2, 5, 7}}};
constexpr std::array<int, 8> mirror_corner = {1, 0, 3, 2, 5, 4, 7, 6};

constexpr double stated_reach = 1, stated_acceleration = 9.81;
constexpr std::array<int, 2> frame_rates = {60, 240};  // per second

struct KindOfSpring {
  const char* key;
  const char* label;
  std::array<double, 3> share;  ///< inside, on the surface, on an edge of the body; 0: not there
};
constexpr std::array<KindOfSpring, 3> spring_kinds = {{{"k_e", "compliance 1/k_e, cell edge", {1, 0.5, 0.25}},
                                                       {"k_f", "compliance 1/k_f, face diagonal", {1, 0.5, 0}},
                                                       {"k_c", "compliance 1/k_c, cube diagonal", {1, 0, 0}}}};
constexpr const char* spring_places[] = {"inside", "surface", "edge"};

void add_compliances(const EngineFacts& f, std::vector<FactRow>& rows) {
  for (std::size_t kind = 0; kind < spring_kinds.size(); ++kind) {
    FactRow row{spring_kinds[kind].label, "m/N", {}};
    for (std::size_t place = 0; place < 3; ++place)
      if (const double k = f.inner[kind] * spring_kinds[kind].share[place]; k > 0) {
        row.facts.push_back(
            {fmt::format("/engines/compliance_m_N/{}/{}", spring_kinds[kind].key, spring_places[place]), 1 / k});
        row.note += (row.note.empty() ? "" : ", ") + std::string(spring_places[place]);
      }
    if (!row.facts.empty()) rows.push_back(row);
  }
}

void add_damping(const EngineFacts& f, std::vector<FactRow>& rows) {
  rows.push_back({"", "Hz", {{"/engines/implicit_euler/frequency_Hz", f.frequency}}});
  for (std::size_t i = 0; i < frame_rates.size(); ++i) {
    const std::string place = fmt::format("/engines/implicit_euler/damping/{}/", i);
    const double step = 1.0 / frame_rates[i];
    rows.push_back({"", "s", {{place + "time_step_s", step}}});
    rows.push_back({fmt::format("implicit Euler damps {:g} Hz in steps of 1/{} s by", f.frequency, frame_rates[i]),
                    "",
                    {{place + "zeta", implicit_euler_damping(f.frequency, step)}},
                    "of the critical, pi f dt"});
  }
}

}  // namespace

BulletNeoHooke bullet_neo_hooke(const IsotropicMaterial& m) {
  const double G = shear_modulus(m);
  return {4.0 / 3 * G, lame_lambda(m) + 5.0 / 6 * G};
}

double volume_compliance(double tetrahedron_volume, double bulk) { return 36 * tetrahedron_volume / bulk; }

double implicit_euler_damping(double frequency, double time_step) { return std::numbers::pi * frequency * time_step; }

double least_single_precision_step(double reach, double acceleration) {
  return std::sqrt(std::ldexp(reach, -23) / acceleration);
}

double largest_sweep_step(double safe_time_step) { return 0.25 * safe_time_step; }

double safe_time_step_of_tetrahedra(const IsotropicMaterial& m, double edge) {
  const double G = shear_modulus(m), lambda = lame_lambda(m);
  NodalVectors X(8, 3);
  Hexahedron cell;
  for (int c = 0; c < 8; ++c) {
    cell[c] = c;
    for (int d = 0; d < 3; ++d) X(c, d) = hexahedron_corners[c][d];
  }
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(24, 24);  // of a cube of edge 1 m
  for (const Tetrahedron& t : five_tetrahedra(X, {cell}, 1)) {
    Eigen::Matrix4d corners;
    for (int a = 0; a < 4; ++a) corners.row(a) << 1, X.row(t[a]);
    const double volume = corners.determinant() / 6;
    const Eigen::Matrix<double, 3, 4> gradient = corners.inverse().bottomRows(3);  // of the shape functions
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < 4; ++b) {
        const Vec3 g = gradient.col(a), h = gradient.col(b);
        K.block<3, 3>(3 * t[a], 3 * t[b]) +=
            volume * (lambda * g * h.transpose() + G * h * g.transpose() + G * g.dot(h) * Eigen::Matrix3d::Identity());
      }
  }
  const double stiffest = symmetric_eigenvalues(K)[23] / (m.density / 8);
  return 2 * edge / std::sqrt(stiffest);
}

std::vector<Tetrahedron> five_tetrahedra(const NodalVectors& X, const std::vector<Hexahedron>& cells, double edge) {
  std::vector<Tetrahedron> tetrahedra;
  tetrahedra.reserve(five_of_cube.size() * cells.size());
  for (const Hexahedron& cell : cells) {
    const Eigen::RowVector3d place = (X.row(cell[0]) - X.row(cells.front()[0])) / edge;
    const bool odd = (std::lround(place[0]) + std::lround(place[1]) + std::lround(place[2])) % 2 != 0;
    for (const Tetrahedron& t : five_of_cube)
      if (odd)
        tetrahedra.push_back({cell[mirror_corner[t[1]]], cell[mirror_corner[t[0]]], cell[mirror_corner[t[2]]],
                              cell[mirror_corner[t[3]]]});
      else
        tetrahedra.push_back({cell[t[0]], cell[t[1]], cell[t[2]], cell[t[3]]});
  }
  return tetrahedra;
}

FactGroup facts_of(const EngineFacts& f) {
  FactGroup group{"for real-time engines (docs/engines.md)"};
  add_compliances(f, group.rows);
  const bool corrects = f.correction > 0;
  group.rows.push_back(
      {corrects ? "constraint on 6 V of a sixth of a cell that adds kappa" : "",
       "m^5/N",
       {{"/engines/volume_compliance_m5_N",
         corrects ? FactValue(volume_compliance(f.edge * f.edge * f.edge / 6, f.correction)) : FactValue()}},
       "36 V / kappa; tetrahedra lock"});
  const BulletNeoHooke bullet = bullet_neo_hooke(f.material);
  group.rows.push_back({"Bullet's neo-Hooke, mu", "Pa", {{"/engines/bullet_neo_hooke/mu_Pa", bullet.mu}}, "4/3 G"});
  group.rows.push_back(
      {"Bullet's neo-Hooke, lambda", "Pa", {{"/engines/bullet_neo_hooke/lambda_Pa", bullet.lambda}}, "Lame's + 5/6 G"});
  add_damping(f, group.rows);
  group.rows.push_back({"", "m", {{"/engines/single_precision/reach_m", stated_reach}}});
  group.rows.push_back({"", "m/s^2", {{"/engines/single_precision/acceleration_m_s2", stated_acceleration}}});
  group.rows.push_back(
      {"single precision: least step",
       "s",
       {{"/engines/single_precision/least_time_step_s",
         least_single_precision_step(stated_reach, stated_acceleration)}},
       fmt::format("sqrt(1.2e-7 |x| / g), at |x| = {:g} m, g = {:g} m/s^2", stated_reach, stated_acceleration)});
  return group;
}

}  // namespace springproof
