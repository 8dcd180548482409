#include "msm/statics/mixed_newton.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "msm/parameters/calibrate.h"
#include "problem/system/progress.h"

namespace springproof {
namespace {

constexpr double pressure_tolerance = 1e-8;
constexpr int most_krylov_steps = 200;

const VolumeCorrection* volume_of(const MassSpringModel& model) {
  const VolumeCorrection* found = nullptr;
  for (const ForceLaw& law : model.laws)
    if (const auto* v = std::get_if<VolumeCorrection>(&law)) found = v;
  return found;
}

}  // namespace

struct MixedNewton::Linearised {
  std::vector<MeanEdgeVolume> volumes;
  Eigen::VectorXd curvature;  ///< psi'' per cell
  Eigen::VectorXd force;      ///< external - internal force [N]
  Eigen::VectorXd mismatch;   ///< (p / kappa - psi') / psi'' V [m^3]
};

bool MixedNewton::suits(const MassSpringModel& model) {
  const VolumeCorrection* volume = volume_of(model);
  return volume && consists_of_cells(model) && volume->kappa > mixed_above_kappa * affine_shear_modulus(model.network);
}

MixedNewton::MixedNewton(const MassSpringModel& model, const std::vector<char>& fixed)
    : model_(model), volume_(*volume_of(model)), fixed_(fixed) {
  unit_pressure_ = affine_shear_modulus(model.network);
  unit_length_ = model.network.cell_edge;
  multigrid_ = std::make_unique<MixedMultigrid>(lattice_levels(model.network, fixed),
                                                in_units(cell_stiffness(model), unit_pressure_, unit_length_));
  K_ = BlockMatrix(coupled_nodes(model.network));
  p_ = accepted_p_ = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(model.network.cells.size()));
}

MixedNewton::Linearised MixedNewton::linearise(const NodalVectors& x, const Eigen::VectorXd& external) {
  const Network& network = model_.network;
  const double V = network.cell_volume();
  Linearised at{{}, Eigen::VectorXd(p_.size()), external, Eigen::VectorXd(p_.size())};
  K_.set_zero();
  NodalVectors f = NodalVectors::Zero(x.rows(), 3);
  for (const ForceLaw& law : model_.laws) {
    if (std::holds_alternative<VolumeCorrection>(law)) continue;
    std::visit(
        [&](const auto& l) {
          l.add_forces(network, x, f);
          l.add_tangent(network, x, K_);
        },
        law);
  }
  at.volumes.reserve(network.cells.size());
  for (std::size_t c = 0; c < network.cells.size(); ++c) {
    const MeanEdgeVolume& v = at.volumes.emplace_back(mean_edge_volume(network.cells[c], x));
    const VolumeDensity d = volume_density(volume_.form, v.value / V);
    const auto i = static_cast<Eigen::Index>(c);
    at.curvature[i] = d.curvature;
    at.mismatch[i] = V * (p_[i] / volume_.kappa - d.slope) / d.curvature;
    for (int n = 0; n < 8; ++n) f.row(network.cells[c][n]) -= p_[i] * v.gradient.row(n);
    add_volume_curvature(network.cells[c], v, p_[i], K_);
  }
  at.force += flat(f);
  return at;
}

/// K du + g^T dp = r on free unknowns, g du - V / (kappa psi'') dp = h.
void MixedNewton::solve(const Linearised& at, const Eigen::VectorXd& r, const Eigen::VectorXd& h, double tolerance,
                        Eigen::VectorXd& du, Eigen::VectorXd& dp) {
  const Network& network = model_.network;
  const Eigen::Index n = r.size(), m = h.size();
  const double area = unit_length_ * unit_length_, volume = area * unit_length_,
               stiffness = unit_pressure_ * unit_length_;
  const auto clear = [&](Eigen::VectorXd& v) {
    for (Eigen::Index i = 0; i < n; ++i)
      if (fixed_[i]) v[i] = 0;
  };
  Eigen::VectorXd u(n), Ku;
  const Operator A = [&](const Eigen::VectorXd& x, Eigen::VectorXd& y) {
    y.resize(n + m);
    u = x.head(n);
    K_.multiply(u, Ku);
    y.head(n) = Ku / stiffness;
    for (Eigen::Index c = 0; c < m; ++c) {
      const Hexahedron& cell = network.cells[c];
      double change = 0;
      for (int k = 0; k < 8; ++k) {
        change += at.volumes[c].gradient.row(k).dot(u.segment<3>(3 * cell[k]));
        y.segment<3>(3 * cell[k]) += x[n + c] / area * at.volumes[c].gradient.row(k).transpose();
      }
      y[n + c] = change / area - unit_pressure_ / (volume_.kappa * at.curvature[c]) * x[n + c];
    }
    clear(y);
  };
  const Operator precondition = [&](const Eigen::VectorXd& x, Eigen::VectorXd& z) {
    Eigen::VectorXd z_u, z_p;
    multigrid_->apply(x.head(n), x.tail(m), z_u, z_p);
    z.resize(n + m);
    z << z_u, z_p;
  };
  Eigen::VectorXd b(n + m), x = Eigen::VectorXd::Zero(n + m);
  b << r / (unit_pressure_ * area), h / volume;
  clear(b);
  gmres(A, precondition, b, tolerance, most_krylov_steps, 60, x);
  du = unit_length_ * x.head(n);
  dp = unit_pressure_ * x.tail(m);
}

bool MixedNewton::step(const BoundaryConditions& bc, double tolerance, int max_iterations, NodalVectors& x) {
  p_ = accepted_p_;
  const Network& network = model_.network;
  Eigen::VectorXd du = Eigen::VectorXd::Zero(x.size()), dp;
  for (Eigen::Index i = 0; i < x.size(); ++i)
    if (fixed_[i]) du[i] = network.X.data()[i] + bc.prescribed.data()[i] - x.data()[i];
  for (int k = 0; k <= max_iterations; ++k) {
    const Linearised at = linearise(x, flat(bc.external));
    double on_fixed = 0, on_free = 0;
    for (Eigen::Index i = 0; i < at.force.size(); ++i) (fixed_[i] ? on_fixed : on_free) += at.force[i] * at.force[i];
    const double scale = std::sqrt(std::max(on_fixed, bc.external.squaredNorm())),
                 relative = scale > 0 ? std::sqrt(on_free) / scale : 0;
    if (!std::isfinite(relative)) return false;
    const double pressures = volume_.kappa / network.cell_volume() * at.mismatch.cwiseProduct(at.curvature).norm();
    if (k > 0 && relative <= tolerance && pressures <= pressure_tolerance * p_.norm()) return true;
    if (k == max_iterations) return false;
    ++iterations_;
    progress::detail([&] {
      return fmt::format("{} unknowns, Newton step {} at this load, residual {:.1e}", x.size(), k + 1, relative);
    });
    Eigen::VectorXd r = at.force, h = at.mismatch, moved = Eigen::VectorXd::Zero(x.size());
    if (k == 0) {  // the displacements of the supports are known
      Eigen::VectorXd Ku;
      K_.multiply(du, Ku);
      r -= Ku;
      for (Eigen::Index c = 0; c < h.size(); ++c)
        for (int n = 0; n < 8; ++n) h[c] -= at.volumes[c].gradient.row(n).dot(du.segment<3>(3 * network.cells[c][n]));
      moved = du;
    }
    Eigen::VectorXd correction;
    solve(at, r, h, std::clamp(1e-2 * relative, 1e-8, 1e-3), correction, dp);
    correction += moved;
    x += Eigen::Map<const NodalVectors>(correction.data(), x.rows(), 3);
    p_ += dp;
  }
  return false;
}

}  // namespace springproof
