#include "msm/laws/nodal_gradients.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <limits>
#include <stdexcept>

namespace springproof {
namespace {

using Mat3 = Eigen::Matrix3d;
using Vector9 = Eigen::Matrix<double, 9, 1>;
constexpr double least_volume = 1e-3;  // det B over that of an isotropic B of the same trace

/// Those of a lattice of cells; of other networks all directions alike.
std::vector<SpringDirection> directions_of(const Network& network) {
  const auto all = spring_directions();
  if (network.cells.springs.empty()) return {all.begin(), all.end()};
  std::vector<SpringDirection> own;
  double sum = 0;
  for (const Spring& s : network.cells.springs) {
    const Vec3 n = (network.X.row(network.cells.corners[0][s.j]) - network.X.row(network.cells.corners[0][s.i]))
                       .transpose()
                       .normalized();
    const double weight = s.stiffness * s.rest_length * s.rest_length;
    sum += weight;
    const auto same =
        std::find_if(own.begin(), own.end(), [&](const SpringDirection& d) { return std::abs(d.n.dot(n)) > 1 - 1e-9; });
    if (same != own.end())
      same->weight += weight;
    else
      own.push_back({n, weight});
  }
  for (SpringDirection& d : own) d.weight /= sum;
  return own;
}

/// Subtracts `springs`/2 <(|F n| - 1)^2> + `mean`/2 <|F n| - 1>^2, means over the directions.
void subtract_lengths(const std::vector<SpringDirection>& directions, double springs, double mean, const Mat3& F,
                      Derivative up_to, StrainEnergy& W) {
  double m = 0;
  Mat3 of_m = Mat3::Zero();
  for (const auto& [n, weight] : directions) m += weight * ((F * n).norm() - 1);
  for (const auto& [n, weight] : directions) {
    const Vec3 d = F * n;
    const double length = d.norm(), tension = springs * (length - 1) + mean * m;
    W.value -= weight * springs / 2 * (length - 1) * (length - 1);
    if (up_to == Derivative::none) continue;
    const Mat3 by_F = d * n.transpose() / length;
    W.stress -= weight * tension * by_F;
    of_m += weight * by_F;
    if (up_to == Derivative::first) continue;
    const Eigen::Map<const Vector9> b(by_F.data());
    W.tangent -= weight * (springs - tension / length) * b * b.transpose();
    for (int j = 0; j < 3; ++j)
      for (int l = 0; l < 3; ++l)
        W.tangent.block<3, 3>(3 * j, 3 * l).diagonal().array() -= weight * tension / length * n[j] * n[l];
  }
  W.value -= mean / 2 * m * m;
  const Eigen::Map<const Vector9> b(of_m.data());
  if (up_to == Derivative::second) W.tangent -= mean * b * b.transpose();
}

}  // namespace

NodalGradients::NodalGradients(const MomentumDispersion& law_, const Network& network_)
    : law(law_),
      network(network_),
      g(network.springs.size()),
      GV(Eigen::VectorXd::Zero(network.nodes())),
      directions_(directions_of(network)) {
  for (std::size_t s = 0; s < g.size(); ++s) {
    const Spring& spring = network.springs[s];
    const Vec3 N = between(spring, network.X).normalized();
    for (int end = 0; end < 2; ++end)
      g[s][end] = (law.weight.empty() ? spring.stiffness * spring.rest_length : law.weight[2 * s + end]) * N;
  }
  std::vector<Mat3> B = at(network.X);
  for (int n = 0; n < network.nodes(); ++n) {
    if (B[n].isZero(0)) continue;
    const double M = B[n].trace();
    if (!(27 * B[n].determinant() > least_volume * M * M * M))
      throw std::invalid_argument(
          fmt::format("the springs at node {} span no volume: finite strain needs them in three dimensions", n));
    GV[n] = M / 30;
    B[n] = B[n].inverse().eval();
  }
  each_end([&](std::size_t s, int end, int n) { g[s][end] = B[n] * g[s][end]; });
}

std::vector<Mat3> NodalGradients::at(const NodalVectors& x) const {
  std::vector<Mat3> F(network.nodes(), Mat3::Zero());
  each_end([&](std::size_t s, int end, int n) { F[n] += between(network.springs[s], x) * g[s][end].transpose(); });
  return F;
}

StrainEnergy NodalGradients::energy_of(int n, const Mat3& F, Derivative up_to) const {
  const double kappa_V = added_lambda(law) * GV[n];
  StrainEnergy W = springs_energy(law.curve, GV[n], F, up_to);
  add_volume_term(law.curve, kappa_V, F, up_to, W);
  subtract_lengths(directions_, 15 * GV[n], law.of_volumes() ? 0 : 9 * kappa_V, F, up_to, W);
  return W;
}

double NodalGradients::energy(const NodalVectors& x) const {
  const std::vector<Mat3> F = at(x);
  double sum = 0;
  for (int n = 0; n < network.nodes(); ++n) {
    if (GV[n] == 0) continue;
    if (!(F[n].determinant() > 0)) return std::numeric_limits<double>::infinity();
    sum += energy_of(n, F[n], Derivative::none).value;
  }
  return sum;
}

void NodalGradients::add_forces(const NodalVectors& x, NodalVectors& f) const {
  std::vector<Mat3> P = at(x);
  for (int n = 0; n < network.nodes(); ++n)
    if (GV[n] != 0) P[n] = energy_of(n, P[n], Derivative::first).stress;
  pull(P, f);
}

void NodalGradients::pull(const std::vector<Mat3>& P, NodalVectors& f) const {
  each_end([&](std::size_t s, int end, int n) {
    const Vec3 force = P[n] * g[s][end];
    f.row(network.springs[s].i) += force.transpose();
    f.row(network.springs[s].j) -= force.transpose();
  });
}

int NodalGradients::add_flow(const NodalVectors& x, int first, Entries& inflow, Entries& outflow) const {
  const auto add = [&](Entries& form, int row, const Spring& s, const Vec3& by_d) {
    for (int d = 0; d < 3; ++d) {
      form.emplace_back(first + row, 3 * s.j + d, by_d[d]);
      form.emplace_back(first + row, 3 * s.i + d, -by_d[d]);
    }
  };
  if (x == network.X) {
    if (!law.of_volumes()) return 0;
    each_end([&](std::size_t s, int end, int n) {
      add(inflow, n, network.springs[s], g[s][end]);
      add(outflow, n, network.springs[s], added_lambda(law) * GV[n] * g[s][end]);
    });
    return network.nodes();
  }
  const std::vector<Mat3> F = at(x);
  std::vector<Matrix9> C(F.size(), Matrix9::Zero());
  for (int n = 0; n < network.nodes(); ++n)
    if (GV[n] != 0) C[n] = energy_of(n, F[n], Derivative::second).tangent;
  each_end([&](std::size_t s, int end, int n) {
    for (int row = 0; row < 9; ++row) {  // F(i, j) is number i + 3 j
      add(inflow, 9 * n + row, network.springs[s], g[s][end][row / 3] * Vec3::Unit(row % 3));
      const Eigen::Map<const Mat3> of_row(C[n].col(row).data());
      add(outflow, 9 * n + row, network.springs[s], of_row * g[s][end]);
    }
  });
  return 9 * network.nodes();
}

}  // namespace springproof
