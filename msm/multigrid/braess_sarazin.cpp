#include "msm/multigrid/braess_sarazin.h"

namespace springproof {
namespace {

constexpr int sweeps = 2;      // before and after the coarser lattice
constexpr double omega = 1.3;  // damping of the displacement block

}  // namespace

SaddlePointLevel::SaddlePointLevel(const LatticeLevel& level, const CellMatrix& cell, double gradient,
                                   Eigen::Index pressures, double kappa)
    : K(level, cell, gradient), chebyshev_steps_(kappa > 1000 ? 12 : 6) {
  const Eigen::VectorXd diagonal_of_K = diagonal(level, cell);
  inverse_diagonal_ = (diagonal_of_K.array() > 0).select(1 / (omega * diagonal_of_K.array()), 0).cast<float>().matrix();
  level.clear_fixed(inverse_diagonal_);
  f = u = d = Eigen::VectorXf::Zero(3 * level.stride());
  compliance = inverse_schur_diagonal_ = g = p = Bu = r_ = z_ = q_ = Eigen::VectorXf::Zero(pressures);
}

/// Power iteration, with a margin since it approaches from below.
void SaddlePointLevel::bound_schur() {
  for (Eigen::Index i = 0; i < z_.size(); ++i)
    z_[i] = compliance[i] > 0 ? static_cast<float>(1 + 0.5 * ((i * 7919) % 13 - 6) / 6.0) : 0;
  for (int k = 0; k < 20; ++k) {
    z_.normalize();
    r_.setZero();
    schur_step(ChebyshevStep(0.0, -1.0));
    schur_bound_ = 1.15 * z_.norm();
  }
}

void SaddlePointLevel::restrict_to(SaddlePointLevel& below) {
  const LatticeLevel& lattice = below.K.level();
  below.f.setZero();
  below.g.setZero();
  restrict_field(lattice, K.kernels(), K.stride(), d.data(), below.f.data());
  lattice.clear_fixed(below.f);
  restrict_pressures(below);
}

void SaddlePointLevel::prolongate(const SaddlePointLevel& below) {
  prolongate_field(below.K.level(), K.kernels(), below.u.data(), K.stride(), d.data());
  K.level().clear_fixed(d);
  u += d;
  prolongate_pressures(below);
}

void SaddlePointLevel::residual() {
  take_residual();
  K.level().clear_fixed(d);
}

void SaddlePointLevel::sweep(bool from_zero) {
  predict(from_zero);
  const ChebyshevStep start(1, schur_bound_);  // S q = r, nearly
  z_ = static_cast<float>(start.step) * inverse_schur_diagonal_.cwiseProduct(r_);
  q_ = z_;
  for (int k = 2; k <= chebyshev_steps_; ++k) schur_step(ChebyshevStep(k, schur_bound_));
  correct_displacements();
  p += q_;
}

/// Bending moves a thin part's middle without change of volume; the deformation of its sections that goes with it is
/// left to the sweeps.
void SaddlePointLevel::correct_thin_parts() {
  residual();
  Eigen::VectorXf motion = Eigen::VectorXf::Zero(u.size());
  thin_->correct(d.data(), motion.data());
  u += motion;
}

void SaddlePointLevel::smooth(Smoothing when) {
  const bool before = when == Smoothing::before_coarse;
  if (before) {
    u.setZero();
    p.setZero();
  }
  if (!before && thin_) correct_thin_parts();
  for (int s = 0; s < sweeps; ++s) sweep(before && s == 0);
  if (before && thin_) correct_thin_parts();
}

Eigen::VectorXd LatticeSaddlePoint::pressure_rows(const Eigen::VectorXd& p) {
  Eigen::VectorXd rows = Eigen::VectorXd::Zero(finest().p.size());
  const std::vector<int>& place = place_of_pressure();
  for (std::size_t i = 0; i < place.size(); ++i) rows[place[i]] = p[static_cast<Eigen::Index>(i)];
  return rows;
}

Eigen::VectorXd LatticeSaddlePoint::pressures_of(const Eigen::VectorXd& rows) const {
  const std::vector<int>& place = place_of_pressure();
  Eigen::VectorXd p(static_cast<Eigen::Index>(place.size()));
  for (std::size_t i = 0; i < place.size(); ++i) p[static_cast<Eigen::Index>(i)] = rows[place[i]];
  return p;
}

Eigen::VectorXd LatticeSaddlePoint::force(const MixedVector& x) {
  Eigen::VectorXd u, f;
  lattice().to_rows(Nodal::displacements, x.u, u);
  Eigen::VectorXd y = Eigen::VectorXd::Zero(u.size());
  force_rows(u.data(), pressure_rows(x.p).data(), y.data());
  lattice().from_rows(Nodal::forces, y, f);
  return f;
}

Eigen::VectorXd LatticeSaddlePoint::volume_change(const Eigen::VectorXd& u) {
  Eigen::VectorXd u_rows, J = Eigen::VectorXd::Zero(finest().p.size());
  lattice().to_rows(Nodal::displacements, u, u_rows);
  volume_change_rows(u_rows.data(), J.data());
  return pressures_of(J);
}

MixedVector LatticeSaddlePoint::cycle(const MixedVector& b) {
  SaddlePointLevel& top = finest();
  Eigen::VectorXd f, u;
  lattice().to_rows(Nodal::forces, b.u, f);
  top.f = f.cast<float>();
  top.g = pressure_rows(b.p).cast<float>();
  cycle_on_levels();
  lattice().from_rows(Nodal::displacements, top.u.cast<double>(), u);
  return {u, pressures_of(top.p.cast<double>())};
}

}  // namespace springproof
