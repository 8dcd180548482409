#include "msm/statics/mixed_newton.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "msm/multigrid/cut_mixed_multigrid.h"
#include "msm/multigrid/cut_multigrid.h"
#include "msm/multigrid/mixed_multigrid.h"
#include "msm/parameters/calibrate.h"
#include "problem/system/progress.h"

namespace springproof {
namespace {

constexpr double pressure_tolerance = 1e-8;
constexpr int most_krylov_steps = 200;

/// The volume term of a model, and its other laws.
struct Split {
  double kappa = 0;
  std::function<VolumeDensity(double J)> density;
  std::vector<ForceLaw> springs;
};

Split split(const MassSpringModel& model) {
  Split s;
  for (const ForceLaw& law : model.laws)
    if (const auto* volume = std::get_if<VolumeCorrection>(&law)) {
      s.kappa = volume->kappa;
      s.density = [form = volume->form](double J) { return volume_density(form, J); };
    } else if (const auto* averaged = std::get_if<AveragedSprings>(&law)) {
      AveragedSprings alone = *averaged;
      alone.lame_lambda = averaged->shear_modulus;
      s.springs.emplace_back(alone);
      s.kappa = averaged->lame_lambda - averaged->shear_modulus;
      s.density = [curve = averaged->curve](double J) { return volume_term(curve, J); };
    } else {
      s.springs.push_back(law);
    }
  return s;
}

}  // namespace

struct MixedNewton::Linearised {
  std::vector<CellVolume> volumes;
  Eigen::VectorXd curvature;  ///< psi'' per cell
  Eigen::VectorXd force;      ///< external - internal force [N]
  Eigen::VectorXd mismatch;   ///< (p / kappa - psi') / psi'' V [m^3]
};

bool MixedNewton::suits(const MassSpringModel& model) {
  const bool cut = CutMultigrid::covers(model);
  return (cut || consists_of_cells(model)) &&
         split(model).kappa > (cut ? cut_cells_mixed_above_kappa : mixed_above_kappa) * affine_shear_modulus(model);
}

MixedNewton::MixedNewton(const MassSpringModel& model, const std::vector<char>& fixed)
    : network_(model.network), fixed_(fixed) {
  Split parts = split(model);
  springs_ = std::move(parts.springs);
  kappa_ = parts.kappa;
  density_ = std::move(parts.density);
  unit_pressure_ = affine_shear_modulus(model);
  unit_length_ = model.network.cell_edge;
  const auto use = [this](auto multigrid) {
    precondition_ = [multigrid](const auto& f, const auto& g, auto& u, auto& p) { multigrid->apply(f, g, u, p); };
  };
  if (CutMultigrid::covers(model))
    use(std::make_shared<CutMixedMultigrid>(model, fixed));
  else
    use(std::make_shared<MixedMultigrid>(lattice_levels(model.network, fixed),
                                         in_units(cell_stiffness(model), unit_pressure_, unit_length_)));
  K_ = BlockMatrix(model.network);
  rest_volume_.resize(static_cast<Eigen::Index>(network_.cells.size()));
  for (std::size_t c = 0; c < network_.cells.size(); ++c)
    rest_volume_[static_cast<Eigen::Index>(c)] = cell_volume(network_, c, network_.X).value;
  p_ = accepted_p_ = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(model.network.cells.size()));
}

MixedNewton::Linearised MixedNewton::linearise(const NodalVectors& positions, const Eigen::VectorXd& external) {
  NodalVectors x = positions;
  carry(network_.carried, x);
  Linearised at{{}, Eigen::VectorXd(p_.size()), external, Eigen::VectorXd(p_.size())};
  K_.set_zero();
  NodalVectors f = NodalVectors::Zero(x.rows(), 3);
  for (const ForceLaw& law : springs_)
    std::visit(
        [&](const auto& l) {
          l.add_forces(network_, x, f);
          l.add_tangent(network_, x, K_);
        },
        law);
  at.volumes.reserve(network_.cells.size());
  for (std::size_t c = 0; c < network_.cells.size(); ++c) {
    const CellVolume& v = at.volumes.emplace_back(cell_volume(network_, c, x));
    const auto i = static_cast<Eigen::Index>(c);
    const VolumeDensity d = density_(v.value / rest_volume_[i]);
    at.curvature[i] = d.curvature;
    at.mismatch[i] = rest_volume_[i] * (p_[i] / kappa_ - d.slope) / d.curvature;
    for (int n = 0; n < 8; ++n) f.row(network_.cells[c][n]) -= p_[i] * v.gradient.segment<3>(3 * n).transpose();
    add_volume_curvature(network_, c, x, p_[i], K_);
  }
  hand_back(network_.carried, f);
  at.force += flat(f);
  return at;
}

/// K du + g^T dp = r on free unknowns, g du - V / (kappa psi'') dp = h.
void MixedNewton::solve(const Linearised& at, const Eigen::VectorXd& r, const Eigen::VectorXd& h, double tolerance,
                        Eigen::VectorXd& du, Eigen::VectorXd& dp) {
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
    carry(network_.carried, u);
    K_.multiply(u, Ku);
    y.head(n) = Ku / stiffness;
    for (Eigen::Index c = 0; c < m; ++c) {
      const Hexahedron& cell = network_.cells[c];
      double change = 0;
      for (int k = 0; k < 8; ++k) {
        const auto gradient = at.volumes[c].gradient.segment<3>(3 * k);
        change += gradient.dot(u.segment<3>(3 * cell[k]));
        y.segment<3>(3 * cell[k]) += x[n + c] / area * gradient;
      }
      y[n + c] = change / area - unit_pressure_ / (kappa_ * at.curvature[c]) * rest_volume_[c] / volume * x[n + c];
    }
    hand_back(network_.carried, y);
    clear(y);
  };
  const Operator precondition = [&](const Eigen::VectorXd& x, Eigen::VectorXd& z) {
    Eigen::VectorXd z_u, z_p;
    precondition_(x.head(n), x.tail(m), z_u, z_p);
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
  Eigen::VectorXd du = Eigen::VectorXd::Zero(x.size()), dp;
  for (Eigen::Index i = 0; i < x.size(); ++i)
    if (fixed_[i]) du[i] = network_.X.data()[i] + bc.prescribed.data()[i] - x.data()[i];
  for (int k = 0; k <= max_iterations; ++k) {
    const Linearised at = linearise(x, flat(bc.external));
    double on_fixed = 0, on_free = 0;
    for (Eigen::Index i = 0; i < at.force.size(); ++i) (fixed_[i] ? on_fixed : on_free) += at.force[i] * at.force[i];
    const double scale = std::sqrt(std::max(on_fixed, bc.external.squaredNorm())),
                 relative = scale > 0 ? std::sqrt(on_free) / scale : 0;
    if (!std::isfinite(relative)) return false;
    const double pressures = kappa_ * at.mismatch.cwiseProduct(at.curvature).cwiseQuotient(rest_volume_).norm();
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
        for (int n = 0; n < 8; ++n)
          h[c] -= at.volumes[c].gradient.segment<3>(3 * n).dot(du.segment<3>(3 * network_.cells[c][n]));
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
