#include "msm/dynamics/terms/relaxing_cells.h"

#include "msm/dynamics/terms/viscosity.h"
#include "msm/laws/capabilities.h"
#include "problem/system/input_error.h"

namespace springproof {
namespace {

using Corners = Eigen::Matrix<double, 3, 8>;
using InPatterns = Eigen::Matrix<double, 3, 4>;

/// F and the patterns of the positions of a cell's corners.
struct CellState {
  Eigen::Matrix3d F;
  InPatterns q;  ///< [m]

  CellState(const CellForm& form, const Hexahedron& cell, const NodalVectors& x) {
    Corners p;
    for (int n = 0; n < 8; ++n) p.col(n) = x.row(cell[n]).transpose();
    F = p * form.gradient.transpose();
    q = p * corner_patterns();
  }

  CellStrains strains() const {
    CellStrains s;
    const Eigen::Matrix3d E = (F.transpose() * F - Eigen::Matrix3d::Identity()) / 2;
    s << E - E.trace() / 3 * Eigen::Matrix3d::Identity(), F.transpose() * q;
    return s;
  }
};

/// Hourglass forces of components v [N].
InPatterns hourglass_forces(const CellForm& form, const CellStrains& s) {
  InPatterns v = s.rightCols<4>(), w;
  Eigen::Map<Eigen::Matrix<double, 12, 1>>(w.data()) =
      form.hourglass * Eigen::Map<const Eigen::Matrix<double, 12, 1>>(v.data());
  return w;
}

/// f += the forces of stresses of strains `Q`, in the state `at`.
void add_forces_of(const CellForm& form, double shear_modulus, const CellState& at, const CellStrains& Q,
                   const Hexahedron& cell, NodalVectors& f) {
  const InPatterns w = hourglass_forces(form, Q);
  const Eigen::Matrix3d stress = 2 * shear_modulus * form.volume * at.F * Q.leftCols<3>() + at.q * w.transpose();
  const Corners gradient = stress * form.gradient + at.F * w * corner_patterns().transpose();
  for (int n = 0; n < 8; ++n) f.row(cell[n]) -= gradient.col(n).transpose();
}

/// What a sum of branches of 1 adds to the hourglass stiffness of the long-time solid: bending modes are stiff as E /
/// (1 - nu^2), whose bulk modulus does not relax, torsional ones as G.
HourglassStiffness of_branches(const HourglassStiffness& relaxed, const IsotropicMaterial& material, double sum) {
  const double nu = material.poisson_ratio, sudden = with_shear(material, 1 + sum).poisson_ratio;
  const auto bending = [](double ratio) { return HourglassStiffness::of_pattern(2, ratio, true, true).bending; };
  HourglassStiffness k = relaxed;
  k.bending *= ((1 + sum) * bending(sudden) - bending(nu)) / (sum * bending(nu));
  if (relaxed.coupling == nu * relaxed.bending)  // exact for the solid
    k.coupling = relaxed.bending * ((1 + sum) * sudden * bending(sudden) - nu * bending(nu)) / (sum * bending(nu));
  return k;
}

}  // namespace

RelaxingCells RelaxingCells::of(const MassSpringModel& model, const IsotropicMaterial& material,
                                const Relaxation& relaxation) {
  if (!relaxation.acts()) return {};
  if (const std::string why = lacks(model, Capability::relaxation); !why.empty())
    throw InputError("relaxation does not suit this model: " + why);
  RelaxingCells out{relaxation, averaged_beside(model, material)};
  out.cells.hourglass = of_branches(out.cells.hourglass, material, relaxation.instantaneous() - 1);
  return out;
}

Overstrains::Overstrains(const Network& network, const RelaxingCells& relaxing)
    : network_(network), branches_(relaxing.relaxation.branches), shear_modulus_(relaxing.cells.shear_modulus) {
  if (!acts()) return;
  forms_ = CellForms(relaxing.cells, network.cells);
  strains_.resize(network.cells.size());
  relax(network.X);
}

void Overstrains::relax(const NodalVectors& x) {
  for (std::size_t c = 0; c < strains_.size(); ++c)
    strains_[c] = CellState(forms_[c], network_.cells.corners[c], x).strains();
  of_branches_.assign(branches_.size() * strains_.size(), CellStrains::Zero());
  dissipated_ = 0;
}

void Overstrains::add_forces(const NodalVectors& x, double dt, NodalVectors& f) const {
  if (!acts()) return;
  for (std::size_t c = 0; c < strains_.size(); ++c) {
    const CellState at(forms_[c], network_.cells.corners[c], x);
    const CellStrains change = at.strains() - strains_[c];
    CellStrains Q = CellStrains::Zero();
    for (std::size_t i = 0; i < branches_.size(); ++i)
      Q += branches_[i].share *
           BranchStep::of(dt / branches_[i].time).end(of_branches_[branches_.size() * c + i], change);
    add_forces_of(forms_[c], shear_modulus_, at, Q, network_.cells.corners[c], f);
  }
  hand_back(network_.cells.carried, f);
}

void Overstrains::add_mean_forces(const NodalVectors& x0, const NodalVectors& x1, double dt, NodalVectors& f) const {
  if (!acts()) return;
  for (std::size_t c = 0; c < strains_.size(); ++c) {
    const Hexahedron& corners = network_.cells.corners[c];
    const CellStrains change = CellState(forms_[c], corners, x1).strains() - strains_[c];
    CellStrains Q = CellStrains::Zero();
    for (std::size_t i = 0; i < branches_.size(); ++i)
      Q += branches_[i].share *
           BranchStep::of(dt / branches_[i].time).mean(of_branches_[branches_.size() * c + i], change);
    add_forces_of(forms_[c], shear_modulus_, CellState(forms_[c], corners, (x0 + x1) / 2), Q, corners, f);
  }
  hand_back(network_.cells.carried, f);
}

/// Twice the energy of strains a of a spring of the long-time moduli, or its work between a and b.
double Overstrains::twice_energy(std::size_t cell, const CellStrains& a, const CellStrains& b) const {
  return 2 * shear_modulus_ * forms_[cell].volume * a.leftCols<3>().cwiseProduct(b.leftCols<3>()).sum() +
         hourglass_forces(forms_[cell], a).cwiseProduct(b.rightCols<4>()).sum();
}

void Overstrains::advance(const NodalVectors& x, double dt) {
  for (std::size_t c = 0; c < strains_.size(); ++c) {
    const CellStrains now = CellState(forms_[c], network_.cells.corners[c], x).strains(), change = now - strains_[c];
    for (std::size_t i = 0; i < branches_.size(); ++i) {
      CellStrains& Q = of_branches_[branches_.size() * c + i];
      const BranchStep step = BranchStep::of(dt / branches_[i].time);
      const CellStrains mean = step.mean(Q, change), end = step.end(Q, change);
      dissipated_ += branches_[i].share * (twice_energy(c, mean, change) - twice_energy(c, end + Q, end - Q) / 2);
      Q = end;
    }
    strains_[c] = now;
  }
}

double Overstrains::energy() const {
  double twice = 0;
  for (std::size_t c = 0; c < strains_.size(); ++c)
    for (std::size_t i = 0; i < branches_.size(); ++i) {
      const CellStrains& Q = of_branches_[branches_.size() * c + i];
      twice += branches_[i].share * twice_energy(c, Q, Q);
    }
  return twice / 2;
}

}  // namespace springproof
