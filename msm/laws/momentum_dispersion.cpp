#include "msm/laws/momentum_dispersion.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "msm/laws/nodal_gradients.h"

namespace springproof {
namespace {

using Coefficients = MomentumDispersion::Coefficients;

Eigen::VectorXd inflow_of(const MomentumDispersion& law, const Coefficients& c, const Network& network,
                          const NodalVectors& x) {
  Eigen::VectorXd J = Eigen::VectorXd::Zero(network.nodes());
  for (std::size_t n = 0; n < c.in.size(); ++n) {
    const Spring& s = network.springs[n];
    const double elongation = (x.row(s.j) - x.row(s.i)).norm() - s.rest_length;
    J[law.sink(network, s.i)] += c.in[n][0] * elongation;
    J[law.sink(network, s.j)] += c.in[n][1] * elongation;
  }
  return J;
}

double tension(const MomentumDispersion& law, const Coefficients& c, const Network& network, const Eigen::VectorXd& J,
               std::size_t s) {
  const Spring& spring = network.springs[s];
  return c.out[s][0] * J[law.sink(network, spring.i)] + c.out[s][1] * J[law.sink(network, spring.j)];
}

void add_forces_of(const MomentumDispersion& law, const Coefficients& c, const Network& network, const NodalVectors& x,
                   const Eigen::VectorXd& J, NodalVectors& f) {
  for (std::size_t n = 0; n < c.in.size(); ++n) {
    const Spring& s = network.springs[n];
    const Eigen::RowVector3d pull = tension(law, c, network, J, n) * (x.row(s.j) - x.row(s.i)).normalized();
    f.row(s.i) += pull;
    f.row(s.j) -= pull;
  }
}

/// The derivatives of inflow and outflow by the elongations, a row per node.
void add_elongations(const MomentumDispersion& law, const Coefficients& c, const Network& network,
                     const NodalVectors& x, std::vector<Eigen::Triplet<double>>& in,
                     std::vector<Eigen::Triplet<double>>& out) {
  in.reserve(12 * c.in.size());
  out.reserve(12 * c.in.size());
  for (std::size_t n = 0; n < c.in.size(); ++n) {
    const Spring& s = network.springs[n];
    const Vec3 e = (x.row(s.j) - x.row(s.i)).transpose().normalized();
    for (int end = 0; end < 2; ++end) {
      if (c.in[n][end] == 0 && c.out[n][end] == 0) continue;
      const int node = law.sink(network, end == 0 ? s.i : s.j);
      for (int d = 0; d < 3; ++d) {
        in.emplace_back(node, 3 * s.j + d, c.in[n][end] * e[d]);
        in.emplace_back(node, 3 * s.i + d, -c.in[n][end] * e[d]);
        out.emplace_back(node, 3 * s.j + d, c.out[n][end] * e[d]);
        out.emplace_back(node, 3 * s.i + d, -c.out[n][end] * e[d]);
      }
    }
  }
}

}  // namespace

MomentumDispersion::Coefficients MomentumDispersion::coefficients(const Network& network) const {
  const std::size_t springs = network.springs.size();
  Coefficients c;
  c.in.resize(springs);
  c.out.resize(springs);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(network.nodes());  // normalisation of each node's outflow
  for (std::size_t s = 0; s < springs; ++s) {
    const Spring& spring = network.springs[s];
    const double k = spring.stiffness, L = spring.rest_length;
    for (int end = 0; end < 2; ++end) {
      double norm = 1;
      switch (form) {
        case Dispersion::symmetric:
        case Dispersion::finite_strain: {
          const double w = weight.empty() ? k * L : weight[2 * s + end];
          c.in[s][end] = w;
          c.out[s][end] = q * w;
          norm = w * L;
          break;
        }
        case Dispersion::share_weighted:
          norm = weight.empty() ? 1 : weight[s];
          c.in[s][end] = q * k * L;
          c.out[s][end] = norm / L;
          break;
        case Dispersion::published:
          c.in[s][end] = q * k * L;
          c.out[s][end] = 1 / L;
          break;
        case Dispersion::published_transposed:
          c.in[s][end] = q * k / L;
          c.out[s][end] = L;
          break;
      }
      sum[sink(network, end == 0 ? spring.i : spring.j)] += norm;
    }
  }
  for (std::size_t s = 0; s < springs; ++s) {
    c.out[s][0] /= sum[sink(network, network.springs[s].i)];
    c.out[s][1] /= sum[sink(network, network.springs[s].j)];
  }
  return c;
}

const char* MomentumDispersion::lacks(Capability what) const {
  using enum Capability;
  const bool by_lattice = what == lattice_kernels || what == gpu,
             by_lists = what == list_kernels || what == list_stiffness;
  const auto gathers = [&](int node) { return group[node] == node; };
  if (what == equal_cells) return "couples nodes beyond a cell";
  if ((by_lattice || by_lists) && form == Dispersion::finite_strain) return "of finite strain has no kernels";
  if (by_lattice && !std::all_of(group.begin(), group.end(), gathers)) return "of groups in groups has no kernels";
  if ((what == energy || what == energy_momentum || what == nodal_pressures) && !has_energy(form))
    return "of this form has no energy";
  return what == nodal_pressures && q <= 0 ? "has no positive fraction" : nullptr;
}

double MomentumDispersion::energy(const Network& network, const NodalVectors& x) const {
  if (!has_energy(form)) return 0;
  double sum = form == Dispersion::finite_strain ? NodalGradients(*this, network).energy(x) : 0;
  if (of_volumes()) return sum;
  const Coefficients c = coefficients(network);
  const Eigen::VectorXd J = inflow_of(*this, c, network, x);
  // Half of tension times elongation: the energy is quadratic in the elongations.
  for (std::size_t s = 0; s < network.springs.size(); ++s) {
    const Spring& spring = network.springs[s];
    sum += 0.5 * tension(*this, c, network, J, s) * ((x.row(spring.j) - x.row(spring.i)).norm() - spring.rest_length);
  }
  return sum;
}

Eigen::VectorXd MomentumDispersion::inflow(const Network& network, const NodalVectors& x) const {
  return inflow_of(*this, coefficients(network), network, x);
}

void MomentumDispersion::add_forces(const Network& network, const NodalVectors& x, NodalVectors& f) const {
  if (form == Dispersion::finite_strain) NodalGradients(*this, network).add_forces(x, f);
  if (of_volumes()) return;
  const Coefficients c = coefficients(network);
  add_forces_of(*this, c, network, x, inflow_of(*this, c, network, x), f);
}

void MomentumDispersion::add_forces(const Network& network, const NodalVectors& x, const Eigen::VectorXd& J,
                                    NodalVectors& f) const {
  add_forces_of(*this, coefficients(network), network, x, J, f);
}

std::vector<double> MomentumDispersion::tensions(const Network& network, const Eigen::VectorXd& J) const {
  const Coefficients c = coefficients(network);
  std::vector<double> T(network.springs.size());
  for (std::size_t s = 0; s < T.size(); ++s) T[s] = tension(*this, c, network, J, s);
  return T;
}

std::vector<double> MomentumDispersion::stiffness_bound(const Network& network, bool of_size) const {
  const Coefficients c = coefficients(network);
  Eigen::VectorXd in = Eigen::VectorXd::Zero(network.nodes()), out = in, product = in;  // |a|^2, |c|^2, a . c
  for (std::size_t s = 0; s < c.in.size(); ++s) {
    const Spring& spring = network.springs[s];
    for (int end = 0; end < 2; ++end) {
      const int n = sink(network, end == 0 ? spring.i : spring.j);
      in[n] += c.in[s][end] * c.in[s][end] / spring.stiffness;
      out[n] += c.out[s][end] * c.out[s][end] / spring.stiffness;
      product[n] += c.in[s][end] * c.out[s][end] / spring.stiffness;
    }
  }
  Eigen::VectorXd R = in.cwiseProduct(out).cwiseSqrt();
  if (!of_size)
    for (Eigen::Index n = 0; n < R.size(); ++n) R[n] = (product[n] > -(1 - 1e-12) * R[n]) ? (R[n] + product[n]) / 2 : 0;
  std::vector<double> k(c.in.size());
  for (std::size_t s = 0; s < k.size(); ++s) {
    const Spring& spring = network.springs[s];
    for (int end = 0; end < 2; ++end)
      if (c.in[s][end] != 0 || c.out[s][end] != 0)
        k[s] += spring.stiffness * R[sink(network, end == 0 ? spring.i : spring.j)];
  }
  return k;
}

void MomentumDispersion::add_tangent(const Network& network, const NodalVectors& x, BlockMatrix& K) const {
  if (of_volumes()) return;  // all of it is in add_flow()
  const Coefficients c = coefficients(network);
  const Eigen::VectorXd J = inflow_of(*this, c, network, x);
  if (J.isZero(0)) return;
  for (std::size_t n = 0; n < c.in.size(); ++n) {
    const Spring& s = network.springs[n];
    const Vec3 d = (x.row(s.j) - x.row(s.i)).transpose();
    const double length = d.norm();
    const Vec3 e = d / length;
    const Eigen::Matrix3d block =
        tension(*this, c, network, J, n) / length * (Eigen::Matrix3d::Identity() - e * e.transpose());
    K.add(s.i, s.i, block);
    K.add(s.j, s.j, block);
    K.add(s.i, s.j, -block);
    K.add(s.j, s.i, -block);
  }
}

void MomentumDispersion::add_flow(const Network& network, const NodalVectors& x, Tangent& K) const {
  std::vector<Eigen::Triplet<double>> in, out;
  int rows = 0;
  if (!of_volumes()) {
    add_elongations(*this, coefficients(network), network, x, in, out);
    rows = network.nodes();
  }
  if (form == Dispersion::finite_strain) rows += NodalGradients(*this, network).add_flow(x, rows, in, out);
  K.inflow.resize(rows, 3 * network.nodes());
  K.outflow.resize(rows, 3 * network.nodes());
  K.inflow.setFromTriplets(in.begin(), in.end());
  K.outflow.setFromTriplets(out.begin(), out.end());
  K.symmetric = K.symmetric && has_energy(form);
}

double dispersed_fraction(double lame_lambda, double shear_modulus, int dimensions) {
  return (lame_lambda - shear_modulus) / (2 * (1 + 2.0 / dimensions) * shear_modulus);
}

double added_lambda(const MomentumDispersion& law, int dimensions) { return 2 * (1 + 2.0 / dimensions) * law.q; }

std::vector<double> spring_shares(const Network& network) {
  std::map<long, double> full;  // by rest length, to one part in a million
  const auto length_class = [](const Spring& s) { return std::lround(1e6 * std::log(s.rest_length)); };
  for (const Spring& s : network.springs) {
    double& k = full[length_class(s)];
    k = std::max(k, s.stiffness);
  }
  std::vector<double> share;
  share.reserve(network.springs.size());
  for (const Spring& s : network.springs) share.push_back(s.stiffness / full[length_class(s)]);
  return share;
}

}  // namespace springproof
