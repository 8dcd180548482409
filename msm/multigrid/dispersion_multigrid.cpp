#include "msm/multigrid/dispersion_multigrid.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "msm/parameters/calibrate.h"
#include "msm/topology/cubic_lattice.h"

namespace springproof {
namespace {

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
  CellStiffness cell = in_units(cell_stiffness(model), G, model.network.cells.edge);
  cell.total = reorder(cell.total, lattice.axes);
  return cell;
}

class NodalPressures : public SaddlePointLevel {
 public:
  /// Springs of stiffness `cell` per cell; `kappa`: what dispersion adds to lambda, over the shear modulus.
  NodalPressures(const LatticeLevel& lattice, const CellMatrix& cell, const NodalVolumes& volumes, double kappa)
      : SaddlePointLevel(lattice, cell, 0, lattice.stride(), kappa), B_(volumes, lattice.stride()) {
    compliance = volumes.compliance.cast<float>();
    const Eigen::VectorXd schur = volumes.compliance + volumes.schur_diagonal(lattice, inverse_diagonal_);
    inverse_schur_diagonal_ = (volumes.compliance.array() > 0).select(1 / schur.array(), 0).cast<float>().matrix();
    y_ = u;
    bound_schur();
    thin_ = ThinParts::of(lattice, cell);
  }

 private:
  void take_residual() override {
    transpose(p);
    K.pass(u.data(), nullptr, nullptr, [&](int a, long begin, long n, const float* Ku) {
      const long at = a * K.stride() + begin;
      d.segment(at, n) = f.segment(at, n) - y_.segment(at, n) - Eigen::Map<const Eigen::VectorXf>(Ku, n);
    });
  }

  void predict(bool from_zero) override {
    if (from_zero)
      d = f;
    else
      take_residual();
    d.array() *= inverse_diagonal_.array();
    y_ = u + d;
    B_.change(y_.data(), r_.data());
    r_ -= g + compliance.cwiseProduct(p);
  }

  void schur_step(const ChebyshevStep& step) override {
    transpose(z_);
    y_.array() *= inverse_diagonal_.array();
    B_.change(y_.data(), Bu.data());
    K.kernels().schur_step(z_.size(), Bu.data(), compliance.data(), inverse_schur_diagonal_.data(),
                           static_cast<float>(step.previous), static_cast<float>(step.step), r_.data(), z_.data(),
                           q_.data());
  }

  void correct_displacements() override {
    transpose(q_);
    u += d - inverse_diagonal_.cwiseProduct(y_);
  }

  /// y = B^T p.
  void transpose(const Eigen::VectorXf& pressures) {
    y_.setZero();
    B_.add_forces(pressures.data(), y_.data());
  }

  NodalVolumeOperator<float> B_;
  Eigen::VectorXf y_;
};

}  // namespace

DispersionMultigrid::DispersionMultigrid(const MassSpringModel& model, const std::vector<char>& fixed, double G)
    : DispersionMultigrid(model, lattice_levels(model.network, fixed, std::min(900, 3 * model.network.nodes() - 1)),
                          G) {}

DispersionMultigrid::DispersionMultigrid(const MassSpringModel& model, LatticeLevels lattice, double G)
    : lattice_(std::move(lattice)),
      volumes_(model, lattice_, G),
      below_(split_finest(lattice_), cell_below(*dispersion_of(model)), true),
      K_(lattice_.levels[0], springs_of(model, lattice_, G).total),
      B_(volumes_, lattice_.levels[0].stride()),
      level_(std::make_unique<NodalPressures>(lattice_.levels[0], springs_of(model, lattice_, G).total, volumes_,
                                              added_lambda(*dispersion_of(model)))) {
  take_compliance(volumes_.compliance);
}

void DispersionMultigrid::cycle_on_levels() {
  two_level_cycle(*level_, below_.finest(), [&] { below_.cycle_on_levels(); });
}

void DispersionMultigrid::force_rows(const double* u, const double* p, double* y) {
  const long stride = K_.stride();
  K_.pass(u, nullptr, nullptr, [&](int a, long begin, long n, const double* Ku) {
    std::memcpy(y + a * stride + begin, Ku, n * sizeof(double));
  });
  B_.add_forces(p, y);
}

}  // namespace springproof
