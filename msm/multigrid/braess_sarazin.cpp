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

void SaddlePointLevel::find_thin_parts(const CellMatrix& cell) {
  auto thin = std::make_unique<ThinParts>(K.level(), cell);
  if (!thin->empty()) thin_ = std::move(thin);
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

void SaddlePointLevel::cycle(const std::function<void()>& add_coarse_correction) {
  u.setZero();
  p.setZero();
  for (int s = 0; s < sweeps; ++s) sweep(s == 0);
  if (thin_) correct_thin_parts();
  residual();
  add_coarse_correction();
  if (thin_) correct_thin_parts();
  for (int s = 0; s < sweeps; ++s) sweep(false);
}

Eigen::VectorXd SaddlePointSystem::to_rows(Nodal kind, const Eigen::VectorXd& u, const Eigen::VectorXd& p) {
  Eigen::VectorXd u_rows, rows = Eigen::VectorXd::Zero(pressures_begin() + finest().p.size());
  lattice().to_rows(kind, u, u_rows);
  rows.head(pressures_begin()) = u_rows;
  const std::vector<int>& place = place_of_pressure();
  for (std::size_t i = 0; i < place.size(); ++i) rows[pressures_begin() + place[i]] = p[static_cast<Eigen::Index>(i)];
  return rows;
}

Eigen::VectorXd SaddlePointSystem::pressures_of(const double* rows) const {
  const std::vector<int>& place = place_of_pressure();
  Eigen::VectorXd p(static_cast<Eigen::Index>(place.size()));
  for (std::size_t i = 0; i < place.size(); ++i) p[static_cast<Eigen::Index>(i)] = rows[place[i]];
  return p;
}

KrylovResult SaddlePointSystem::solve(const Eigen::VectorXd& f, const Eigen::VectorXd& g, double tolerance,
                                      int max_iterations, Eigen::VectorXd& u, Eigen::VectorXd& p) {
  const LatticeLevel& level = lattice().levels[0];
  const Eigen::Index n = pressures_begin(), m = finest().p.size();
  Eigen::VectorXd b = to_rows(Nodal::forces, f, g), x = Eigen::VectorXd::Zero(n + m);
  level.clear_fixed(b);
  const Operator A = [&](const Eigen::VectorXd& v, Eigen::VectorXd& y) {
    y.resize(v.size());
    multiply_rows(v.data(), y.data());
    level.clear_fixed(y);
  };
  const Operator precondition = [&](const Eigen::VectorXd& r, Eigen::VectorXd& z) {
    SaddlePointLevel& top = finest();
    top.f = r.head(n).cast<float>();
    top.g = r.tail(m).cast<float>();
    cycle();
    z.resize(r.size());
    z << top.u.cast<double>(), top.p.cast<double>();
  };
  const KrylovResult result = gmres(A, precondition, b, tolerance, max_iterations, 60, x);
  lattice().from_rows(Nodal::displacements, x, u);
  p = pressures_of(x.data() + n);
  return result;
}

void SaddlePointSystem::apply(const Eigen::VectorXd& f, const Eigen::VectorXd& g, Eigen::VectorXd& u,
                              Eigen::VectorXd& p) {
  SaddlePointLevel& top = finest();
  const Eigen::VectorXd rows = to_rows(Nodal::forces, f, g);
  top.f = rows.head(pressures_begin()).cast<float>();
  top.g = rows.tail(top.p.size()).cast<float>();
  cycle();
  lattice().from_rows(Nodal::displacements, top.u.cast<double>(), u);
  p = pressures_of(top.p.cast<double>().eval().data());
}

Eigen::VectorXd SaddlePointSystem::force(const Eigen::VectorXd& u, const Eigen::VectorXd& p) {
  const Eigen::VectorXd x = to_rows(Nodal::displacements, u, p);
  Eigen::VectorXd y(x.size()), f;
  multiply_rows(x.data(), y.data());
  lattice().from_rows(Nodal::forces, y, f);
  return f;
}

Eigen::VectorXd SaddlePointSystem::volume_change(const Eigen::VectorXd& u) {
  Eigen::VectorXd u_rows, J = Eigen::VectorXd::Zero(finest().p.size());
  lattice().to_rows(Nodal::displacements, u, u_rows);
  volume_change_rows(u_rows.data(), J.data());
  return pressures_of(J.data());
}

}  // namespace springproof
