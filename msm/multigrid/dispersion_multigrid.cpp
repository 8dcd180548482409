#include "msm/multigrid/dispersion_multigrid.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "msm/parameters/calibrate.h"
#include "msm/topology/cubic_lattice.h"

namespace springproof {
namespace {

constexpr int sweeps = 2;      // before and after the coarser lattice
constexpr double omega = 1.3;  // damping of the displacement block in a Braess-Sarazin sweep

/// One HybMSS cell with edge and shear modulus 1 and what dispersion adds to lambda.
CellStiffness cell_below(const MomentumDispersion& law) {
  MassSpringModel cell;
  cell.network = cubic_lattice(block_mesh(Vec3::Ones(), {1, 1, 1}), isotropic_pattern(2));
  calibrate(1.0, cell.network);
  cell.laws = {Springs{}, VolumeCorrection{added_lambda(law)}};
  return cell_stiffness(cell);
}

/// The levels but the finest, which has `all` for itself.
LatticeLevels split_finest(LatticeLevels& all) {
  if (all.levels.size() < 2) throw std::invalid_argument("a single cell has no lattice below it");
  LatticeLevels below;
  below.axes = all.axes;
  below.levels.assign(std::make_move_iterator(all.levels.begin() + 1), std::make_move_iterator(all.levels.end()));
  all.levels.resize(1);
  return below;
}

CellStiffness springs_of(const MassSpringModel& model, const LatticeLevels& lattice, double G) {
  CellStiffness cell = in_units(cell_stiffness(model), G, model.network.cell_edge);
  cell.total = reorder(cell.total, lattice.axes);
  return cell;
}

}  // namespace

DispersionMultigrid::DispersionMultigrid(const MassSpringModel& model, const std::vector<char>& fixed, double G)
    : DispersionMultigrid(model, lattice_levels(model.network, fixed, std::min(900, 3 * model.network.nodes() - 1)),
                          G) {}

DispersionMultigrid::DispersionMultigrid(const MassSpringModel& model, LatticeLevels lattice, double G)
    : lattice_(std::move(lattice)),
      volumes_(model, lattice_, G),
      below_(split_finest(lattice_), cell_below(*dispersion_of(model)), true),
      inner_steps_(added_lambda(*dispersion_of(model)) > 1000 ? 12 : 6),
      K_(lattice_.levels[0], springs_of(model, lattice_, G).total),
      K_double_(lattice_.levels[0], springs_of(model, lattice_, G).total),
      B_(volumes_, lattice_.levels[0].stride()),
      B_double_(volumes_, lattice_.levels[0].stride()) {
  const LatticeLevel& level = lattice_.levels[0];
  const CellMatrix springs = springs_of(model, lattice_, G).total;
  const Eigen::VectorXd d = diagonal(level, springs);
  inverse_diagonal_ = (d.array() > 0).select(1 / (omega * d.array()), 0).cast<float>().matrix();
  level.clear_fixed(inverse_diagonal_);
  const Eigen::VectorXd schur = volumes_.compliance + volumes_.schur_diagonal(level, inverse_diagonal_);
  inverse_schur_diagonal_ = (volumes_.compliance.array() > 0).select(1 / schur.array(), 0).cast<float>().matrix();
  compliance_ = volumes_.compliance.cast<float>();
  f_ = u_ = d_ = y_ = Eigen::VectorXf::Zero(3 * level.stride());
  g_ = p_ = Bu_ = r_ = z_ = q_ = Eigen::VectorXf::Zero(level.stride());
  bound_schur();
  thin_ = std::make_unique<ThinParts>(level, springs);
  if (thin_->empty()) thin_.reset();
}

/// Power iteration, with a margin since it approaches from below.
void DispersionMultigrid::bound_schur() {
  for (Eigen::Index i = 0; i < z_.size(); ++i)
    z_[i] = compliance_[i] > 0 ? static_cast<float>(1 + 0.5 * ((i * 7919) % 13 - 6) / 6.0) : 0;
  for (int k = 0; k < 20; ++k) {
    z_.normalize();
    r_.setZero();
    schur_step(ChebyshevStep(0.0, -1.0));
    schur_bound_ = 1.15 * z_.norm();
  }
}

void DispersionMultigrid::schur_step(const ChebyshevStep& step) {
  y_.setZero();
  B_.add_forces(z_.data(), y_.data());
  y_.array() *= inverse_diagonal_.array();
  B_.change(y_.data(), Bu_.data());
  K_.kernels().schur_step(z_.size(), Bu_.data(), compliance_.data(), inverse_schur_diagonal_.data(),
                          static_cast<float>(step.previous), static_cast<float>(step.step), r_.data(), z_.data(),
                          q_.data());
}

void DispersionMultigrid::residual() {
  y_.setZero();
  B_.add_forces(p_.data(), y_.data());
  K_.pass(u_.data(), nullptr, nullptr, [&](int a, long begin, long n, const float* Ku) {
    const long at = a * K_.stride() + begin;
    d_.segment(at, n) = f_.segment(at, n) - y_.segment(at, n) - Eigen::Map<const Eigen::VectorXf>(Ku, n);
  });
}

void DispersionMultigrid::sweep(bool from_zero) {
  if (from_zero)
    d_ = f_;
  else
    residual();
  d_.array() *= inverse_diagonal_.array();
  y_ = u_ + d_;
  B_.change(y_.data(), r_.data());
  r_ -= g_ + compliance_.cwiseProduct(p_);
  const ChebyshevStep start(1, schur_bound_);  // S q = r, nearly
  z_ = static_cast<float>(start.step) * inverse_schur_diagonal_.cwiseProduct(r_);
  q_ = z_;
  for (int k = 2; k <= inner_steps_; ++k) schur_step(ChebyshevStep(k, schur_bound_));
  y_.setZero();
  B_.add_forces(q_.data(), y_.data());
  u_ += d_ - inverse_diagonal_.cwiseProduct(y_);
  p_ += q_;
}

/// Bending moves a thin part's middle without change of volume; what the sections must do with it is left to the
/// sweeps.
void DispersionMultigrid::correct_thin_parts() {
  residual();
  lattice_.levels[0].clear_fixed(d_);
  y_.setZero();
  thin_->correct(d_.data(), y_.data());
  u_ += y_;
}

void DispersionMultigrid::cycle() {
  u_.setZero();
  p_.setZero();
  for (int s = 0; s < sweeps; ++s) sweep(s == 0);
  if (thin_) correct_thin_parts();
  residual();
  lattice_.levels[0].clear_fixed(d_);
  MixedMultigrid::Level& below = below_.finest();
  below.f.setZero();
  below.g.setZero();
  restrict_field(below_.finest_lattice(), K_.kernels(), K_.stride(), d_.data(), below.f.data());
  below_.finest_lattice().clear_fixed(below.f);
  below_.cycle();
  prolongate_field(below_.finest_lattice(), K_.kernels(), below.u.data(), K_.stride(), d_.data());
  lattice_.levels[0].clear_fixed(d_);
  u_ += d_;
  if (thin_) correct_thin_parts();
  for (int s = 0; s < sweeps; ++s) sweep(false);
}

/// y = A x of (u, p).
void DispersionMultigrid::multiply_rows(const double* x, double* y) {
  const long stride = K_double_.stride();
  const double* p = x + pressures();
  double* Bu = y + pressures();
  K_double_.pass(x, nullptr, nullptr, [&](int a, long begin, long n, const double* Ku) {
    std::memcpy(y + a * stride + begin, Ku, n * sizeof(double));
  });
  for (int a = 0; a < 3; ++a) std::fill_n(y + (a + 1) * stride - array_slack, array_slack, 0.0);
  B_double_.add_forces(p, y);
  B_double_.change(x, Bu);
  for (long n = 0; n < stride; ++n) Bu[n] -= volumes_.compliance[n] * p[n];
}

Eigen::VectorXd DispersionMultigrid::to_rows(const Eigen::VectorXd& u, const Eigen::VectorXd& p) const {
  Eigen::VectorXd u_rows, rows = Eigen::VectorXd::Zero(size());
  lattice_.to_rows(u, u_rows);
  rows.head(pressures()) = u_rows;
  for (std::size_t n = 0; n < lattice_.point_of_node.size(); ++n)
    rows[pressures() + lattice_.point_of_node[n]] = p[static_cast<Eigen::Index>(n)];
  return rows;
}

Eigen::VectorXd DispersionMultigrid::pressures_from_rows(const Eigen::VectorXd& rows) const {
  Eigen::VectorXd p(static_cast<Eigen::Index>(lattice_.point_of_node.size()));
  for (Eigen::Index n = 0; n < p.size(); ++n)
    p[n] = rows[pressures() + lattice_.point_of_node[static_cast<std::size_t>(n)]];
  return p;
}

KrylovResult DispersionMultigrid::solve(const Eigen::VectorXd& f, const Eigen::VectorXd& g, double tolerance,
                                        int max_iterations, Eigen::VectorXd& u, Eigen::VectorXd& p) {
  const LatticeLevel& level = lattice_.levels[0];
  Eigen::VectorXd b = to_rows(f, g), x = Eigen::VectorXd::Zero(size());
  level.clear_fixed(b);
  const Operator A = [&](const Eigen::VectorXd& v, Eigen::VectorXd& y) {
    y.resize(v.size());
    multiply_rows(v.data(), y.data());
    level.clear_fixed(y);
  };
  const Operator condition = [&](const Eigen::VectorXd& r, Eigen::VectorXd& z) {
    f_ = r.head(pressures()).cast<float>();
    g_ = r.tail(level.stride()).cast<float>();
    cycle();
    z.resize(r.size());
    z << u_.cast<double>(), p_.cast<double>();
  };
  const KrylovResult result = gmres(A, condition, b, tolerance, max_iterations, 60, x);
  lattice_.from_rows(x, u);
  p = pressures_from_rows(x);
  return result;
}

Eigen::VectorXd DispersionMultigrid::force(const Eigen::VectorXd& u, const Eigen::VectorXd& p) {
  Eigen::VectorXd y(size()), f;
  multiply_rows(to_rows(u, p).data(), y.data());
  lattice_.from_rows(y, f);
  return f;
}

Eigen::VectorXd DispersionMultigrid::volume_change(const Eigen::VectorXd& u) {
  const Eigen::VectorXd rows =
      to_rows(u, Eigen::VectorXd::Zero(static_cast<Eigen::Index>(lattice_.point_of_node.size())));
  Eigen::VectorXd y = Eigen::VectorXd::Zero(size());
  B_double_.change(rows.data(), y.data() + pressures());
  return pressures_from_rows(y);
}

}  // namespace springproof
