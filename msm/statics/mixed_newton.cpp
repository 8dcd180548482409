#include "msm/statics/mixed_newton.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "msm/algebra/fixed.h"
#include "msm/parameters/calibrate.h"
#include "msm/statics/mixed_form.h"
#include "problem/system/progress.h"

namespace springproof {
namespace {

constexpr double pressure_tolerance = 1e-8;
constexpr int most_krylov_steps = 200;

/// The volume terms of the materials of a model, and its other laws.
struct Split {
  std::vector<double> kappa = {};
  std::vector<std::function<VolumeDensity(double J)>> density = {};
  std::vector<ForceLaw> springs = {};

  explicit Split(const MassSpringModel& model) {
    for (const ForceLaw& law : model.laws) std::visit(*this, law);
  }
  void operator()(const VolumeCorrection& law) {
    kappa = {law.kappa};
    density = {[form = law.form](double J) { return volume_density(form, J); }};
  }
  void operator()(const AveragedSprings& law) {
    MixedParts parts = mixed_parts(law);
    kappa = std::move(parts.kappa);
    for (int m = 0; m < static_cast<int>(kappa.size()); ++m)
      density.emplace_back([curve = law.in(m).curve](double J) { return volume_term(curve, J); });
    springs.emplace_back(std::move(parts.springs));
  }
  template <class Law>
  void operator()(const Law& law) {
    springs.emplace_back(law);
  }
};

}  // namespace

/// The equations at a state, in the units of the saddle point at rest:  K du + g^T dp = r,  g du - V/(kappa psi'') dp =
/// h.
class MixedNewton::Linearised : public SaddlePoint {
 public:
  explicit Linearised(const MixedNewton& newton) : newton_(newton) {}

  Eigen::VectorXd force(const MixedVector& x) override {
    const double l = newton_.unit_length_;
    const Network& network = newton_.network_;
    Eigen::VectorXd u = x.u, y;
    carry(network.cells.carried, u);
    newton_.K_.multiply(u, y);
    y /= newton_.unit_pressure_ * l;
    for (std::size_t c = 0; c < volumes.size(); ++c)
      for (int n = 0; n < 8; ++n)
        y.segment<3>(3 * network.cells.corners[c][n]) +=
            x.p[static_cast<Eigen::Index>(c)] / (l * l) * volumes[c].gradient.segment<3>(3 * n);
    hand_back(network.cells.carried, y);
    return y;
  }

  Eigen::VectorXd volume_change(const Eigen::VectorXd& displacement) override {
    Eigen::VectorXd u = displacement;
    carry(newton_.network_.cells.carried, u);
    return changes(u) / (newton_.unit_length_ * newton_.unit_length_);
  }

  const Eigen::VectorXd& compliance() const override { return compliance_; }
  MixedVector cycle(const MixedVector& b) override { return newton_.rest_->cycle(b); }

  /// g u [m^3] of displacements of all nodes.
  Eigen::VectorXd changes(const Eigen::VectorXd& u) const {
    Eigen::VectorXd change = Eigen::VectorXd::Zero(curvature.size());
    for (std::size_t c = 0; c < volumes.size(); ++c)
      for (int n = 0; n < 8; ++n)
        change[static_cast<Eigen::Index>(c)] +=
            volumes[c].gradient.segment<3>(3 * n).dot(u.segment<3>(3 * newton_.network_.cells.corners[c][n]));
    return change;
  }

  void take_compliance() {
    const double l = newton_.unit_length_;
    compliance_.setOnes(curvature.size());
    for (Eigen::Index c = 0; c < curvature.size(); ++c)
      if (newton_.kappa_[c] > 0)
        compliance_[c] =
            newton_.unit_pressure_ / (newton_.kappa_[c] * l * l * l) * newton_.rest_volume_[c] / curvature[c];
  }

  std::vector<CellVolume> volumes;
  Eigen::VectorXd curvature;   ///< psi'' per cell
  Eigen::VectorXd unbalanced;  ///< external - internal force [N]
  Eigen::VectorXd mismatch;    ///< (p / kappa - psi') / psi'' V [m^3]

 private:
  const MixedNewton& newton_;
  Eigen::VectorXd compliance_;
};

MixedNewton::MixedNewton(const MassSpringModel& model, const std::vector<char>& fixed)
    : network_(model.network), fixed_(fixed) {
  Split parts(model);
  springs_ = std::move(parts.springs);
  density_ = std::move(parts.density);
  unit_pressure_ = affine_shear_modulus(model);
  unit_length_ = model.network.cells.edge;
  rest_ = saddle_point_at_rest(model, fixed);
  K_ = BlockMatrix(model.network);
  rest_volume_.resize(static_cast<Eigen::Index>(network_.cells.size()));
  kappa_.resize(rest_volume_.size());
  for (std::size_t c = 0; c < network_.cells.size(); ++c) {
    rest_volume_[static_cast<Eigen::Index>(c)] = cell_volume(network_, c, network_.X).value;
    kappa_[static_cast<Eigen::Index>(c)] = parts.kappa[network_.cells.material(c)];
  }
  p_ = accepted_p_ = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(model.network.cells.size()));
}

MixedNewton::Linearised MixedNewton::linearise(const NodalVectors& positions, const Eigen::VectorXd& external) {
  NodalVectors x = positions;
  carry(network_.cells.carried, x);
  Linearised at(*this);
  at.curvature.setOnes(p_.size());
  at.mismatch.setZero(p_.size());
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
    const auto i = static_cast<Eigen::Index>(c);
    if (!(kappa_[i] > 0)) {
      at.volumes.push_back({0, Eigen::Matrix<double, 24, 1>::Zero()});
      continue;
    }
    const CellVolume& v = at.volumes.emplace_back(cell_volume(network_, c, x));
    const VolumeDensity d = density_[network_.cells.material(c)](v.value / rest_volume_[i]);
    at.curvature[i] = d.curvature;
    at.mismatch[i] = rest_volume_[i] * (p_[i] / kappa_[i] - d.slope) / d.curvature;
    for (int n = 0; n < 8; ++n) f.row(network_.cells.corners[c][n]) -= p_[i] * v.gradient.segment<3>(3 * n).transpose();
    add_volume_curvature(network_, c, x, p_[i], K_);
  }
  hand_back(network_.cells.carried, f);
  at.unbalanced = external + flat(f);
  at.take_compliance();
  return at;
}

MixedVector MixedNewton::solve(Linearised& at, const Eigen::VectorXd& r, const Eigen::VectorXd& h,
                               double tolerance) const {
  const double area = unit_length_ * unit_length_;
  const MixedVector b{r / (unit_pressure_ * area), h / (area * unit_length_)};
  MixedVector x;
  solve_saddle_point(at, fixed_, b, tolerance, most_krylov_steps, x);
  return {unit_length_ * x.u, unit_pressure_ * x.p};
}

bool MixedNewton::step(const BoundaryConditions& bc, double tolerance, int max_iterations, NodalVectors& x) {
  p_ = accepted_p_;
  Eigen::VectorXd du = Eigen::VectorXd::Zero(x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i)
    if (fixed_[i]) du[i] = network_.X.data()[i] + bc.prescribed.data()[i] - x.data()[i];
  for (int k = 0; k <= max_iterations; ++k) {
    Linearised at = linearise(x, flat(bc.external));
    double on_fixed = 0, on_free = 0;
    for (Eigen::Index i = 0; i < at.unbalanced.size(); ++i)
      (fixed_[i] ? on_fixed : on_free) += at.unbalanced[i] * at.unbalanced[i];
    const double scale = std::sqrt(std::max(on_fixed, bc.external.squaredNorm())),
                 relative = scale > 0 ? std::sqrt(on_free) / scale : 0;
    if (!std::isfinite(relative)) return false;
    const double pressures =
        kappa_.cwiseProduct(at.mismatch).cwiseProduct(at.curvature).cwiseQuotient(rest_volume_).norm();
    if (k > 0 && relative <= tolerance && pressures <= pressure_tolerance * p_.norm()) return true;
    if (k == max_iterations) return false;
    ++iterations_;
    progress::detail([&] {
      return fmt::format("{} unknowns, Newton step {} at this load, residual {:.1e}", x.size(), k + 1, relative);
    });
    Eigen::VectorXd r = at.unbalanced, h = at.mismatch, moved = Eigen::VectorXd::Zero(x.size());
    if (k == 0) {  // the displacements of the supports are known
      Eigen::VectorXd Ku;
      K_.multiply(du, Ku);
      r -= Ku;
      h -= at.changes(du);
      moved = du;
    }
    const MixedVector correction = solve(at, r, h, std::clamp(1e-2 * relative, 1e-8, 1e-3));
    moved += correction.u;
    x += by_point(moved);
    p_ += correction.p;
  }
  return false;
}

}  // namespace springproof
