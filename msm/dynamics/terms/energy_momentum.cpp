#include "msm/dynamics/terms/energy_momentum.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <stdexcept>

#include "msm/cells/cell_corners.h"
#include "msm/laws/anchors.h"
#include "msm/laws/capabilities.h"
#include "msm/laws/nodal_gradients.h"

namespace springproof {
namespace {

using Mat3 = Eigen::Matrix3d;

/// Square of the change of C below which two Gauss points give the work to round-off: their error is of fifth order.
constexpr double small_change = 1e-5;

/// w(C) and S = 2 dw/dC, per unit of volume.
struct Stress {
  double energy;
  Mat3 S;
};

/// A discrete gradient S of w with S : (C1 - C0)/2 = w(C1) - w(C0).
template <class Law>
Mat3 secant_stress(const Mat3& C0, const Mat3& C1, const Law& at) {
  const Mat3 change = C1 - C0, middle = (C0 + C1) / 2;
  const double half = 0.5 / std::sqrt(3.0), size = change.squaredNorm();
  const Mat3 S =
      (at(middle - half * change, Derivative::first).S + at(middle + half * change, Derivative::first).S) / 2;
  if (size < small_change) return S;
  const double work = at(C1, Derivative::none).energy - at(C0, Derivative::none).energy;
  return S + (2 * work - S.cwiseProduct(change).sum()) / size * change;
}

/// Of an energy of F that does not depend on the frame.
template <class Energy>
Stress stress_in(const Mat3& C, Derivative up_to, const Energy& energy) {
  const Mat3 F = C.llt().matrixU();  // any F with F^T F = C
  const StrainEnergy W = energy(F);
  if (up_to == Derivative::none) return {W.value, Mat3::Zero()};
  const Mat3 S = F.triangularView<Eigen::Upper>().solve(W.stress);
  return {W.value, (S + S.transpose()) / 2};
}

/// Force of a tension over the step: along the mean spring, per mean length.
template <class Tension>
void pull_springs(const Network& network, const NodalVectors& x0, const NodalVectors& x1, NodalVectors& f,
                  const Tension& tension) {
  for (std::size_t n = 0; n < network.springs.size(); ++n) {
    const Spring& s = network.springs[n];
    const Eigen::RowVector3d d0 = x0.row(s.j) - x0.row(s.i), d1 = x1.row(s.j) - x1.row(s.i);
    const double length = (d0.norm() + d1.norm()) / 2;
    const Eigen::RowVector3d pull = tension(n, length) / (2 * length) * (d0 + d1);
    f.row(s.i) += pull;
    f.row(s.j) -= pull;
  }
}

struct AddSecantForces {
  const Network& network;
  const CellForms& forms;
  const NodalVectors &x0, &x1;
  NodalVectors& f;

  void operator()(const Springs&) const {
    pull_springs(network, x0, x1, f, [&](std::size_t n, double length) {
      return network.springs[n].stiffness * (length - network.springs[n].rest_length);
    });
  }

  /// The energy is quadratic in the elongations, so the tension of their means does the work.
  void operator()(const MomentumDispersion& law) const {
    if (law.form == Dispersion::finite_strain) pull_nodes(NodalGradients(law, network));
    if (law.of_volumes()) return;
    const std::vector<double> T = law.tensions(network, (law.inflow(network, x0) + law.inflow(network, x1)) / 2);
    pull_springs(network, x0, x1, f, [&](std::size_t n, double) { return T[n]; });
  }

  void pull_nodes(const NodalGradients& nodes) const {
    const std::vector<Mat3> F0 = nodes.at(x0), F1 = nodes.at(x1);
    std::vector<Mat3> P(F0.size(), Mat3::Zero());
    for (int n = 0; n < network.nodes(); ++n) {
      if (nodes.GV[n] == 0) continue;
      const auto at = [&](const Mat3& C, Derivative up_to) {
        return stress_in(C, up_to, [&](const Mat3& F) { return nodes.energy_of(n, F, up_to); });
      };
      P[n] = (F0[n] + F1[n]) / 2 * secant_stress(F0[n].transpose() * F0[n], F1[n].transpose() * F1[n], at);
    }
    nodes.pull(P, f);
  }

  void operator()(const VolumeCorrection& law) const {
    const double V = network.cells.volume();
    const Corners gradient = gradients_at(network.cells.full());
    const auto at = [form = law.form](const Mat3& C, Derivative up_to) -> Stress {
      const double J = std::sqrt(C.determinant());
      const VolumeDensity psi = volume_density(form, J);
      return {psi.value, up_to == Derivative::none ? Mat3::Zero() : Mat3(psi.slope * J * C.inverse())};
    };
    for (std::size_t c = 0; c < network.cells.size(); ++c) {
      const Hexahedron& cell = network.cells.corners[c];
      const Mat3 F0 = corners_at(cell, x0) * gradient.transpose(), F1 = corners_at(cell, x1) * gradient.transpose();
      const Mat3 S = secant_stress(F0.transpose() * F0, F1.transpose() * F1, at);
      subtract(Corners(V * law.in(network.cells.material(c)).kappa / 2 * (F0 + F1) * S * gradient), cell, f);
    }
  }

  void operator()(const AveragedSprings& all) const {
    const auto stress = [](const AveragedSprings& law, const Mat3& C, Derivative up_to) {
      return stress_in(C, up_to, [&](const Mat3& F) {
        StrainEnergy W = springs_energy(law.curve, law.shear_modulus, F, up_to);
        add_volume_term(law.curve, law.lame_lambda - law.shear_modulus, F, up_to, W);
        return W;
      });
    };
    for (std::size_t c = 0; c < network.cells.size(); ++c) {
      const CellForm& form = forms[c];
      const Corners p0 = corners_at(network.cells.corners[c], x0), p1 = corners_at(network.cells.corners[c], x1);
      const Mat3 F0 = p0 * form.gradient.transpose(), F1 = p1 * form.gradient.transpose(), F = (F0 + F1) / 2;
      const Eigen::Matrix<double, 3, 4> q0 = p0 * corner_patterns(), q1 = p1 * corner_patterns(), q = (q0 + q1) / 2,
                                        v = (F0.transpose() * q0 + F1.transpose() * q1) / 2;
      Eigen::Matrix<double, 3, 4> w;
      Eigen::Map<Eigen::Matrix<double, 12, 1>>(w.data()) =
          form.hourglass * Eigen::Map<const Eigen::Matrix<double, 12, 1>>(v.data());
      const AveragedSprings& law = all.in(network.cells.material(c));
      const auto at = [&](const Mat3& C, Derivative up_to) { return stress(law, C, up_to); };
      const Mat3 S = secant_stress(F0.transpose() * F0, F1.transpose() * F1, at);
      const Corners gradient =
          (form.volume * F * S + q * w.transpose()) * form.gradient + F * w * corner_patterns().transpose();
      subtract(gradient, network.cells.corners[c], f);
    }
  }

  /// The energy is quadratic in the deformations, so the stress of their mean does the work.
  void operator()(const MeasuredCells& law) const {
    constexpr StrainOfCell strain = StrainOfCell::logarithmic;
    for (std::size_t c = 0; c < network.cells.size(); ++c) {
      const CellShape shape = network.cells.shape(c);
      const CellAt cell{shape, network.cells.corners[c]};
      const Deformations y = (deformations(strain, cell, x0) + deformations(strain, cell, x1)) / 2;
      add_mean_forces_of(strain, law.form_of_cell(c) * y, cell, x0, x1, f);
    }
  }

  /// Quadratic in the positions; of bonds that turn in v, whose mean over the step has the slope of the mean positions.
  void operator()(const Anchors& law) const {
    const NodalVectors middle = (x0 + x1) / 2;
    law.add_forces(network, middle, f);
    for (const InterfaceBond& b : network.bonds) {
      if (!turns(b)) continue;
      const Vec3 v = (TurnedBond(b, network.X, x0).v() + TurnedBond(b, network.X, x1).v()) / 2;
      const TurnedBond at(b, network.X, middle);
      at.for_each_gradient(b.stiffness * (v - at.v()), [&](int node, const Vec3& g) { f.row(node) -= g.transpose(); });
    }
  }

  template <class Other>
  void operator()(const Other&) const {}
};

}  // namespace

EnergyMomentum::EnergyMomentum(const MassSpringModel& model) : model_(model) {
  if (const std::string why = lacks(model, Capability::energy_momentum); !why.empty()) throw std::invalid_argument(why);
  if (const AveragedSprings* law = averaged_springs_of(model)) forms_ = CellForms(*law, model.network.cells);
}

NodalVectors EnergyMomentum::forces(const NodalVectors& x0, const NodalVectors& x1) const {
  NodalVectors f = NodalVectors::Zero(x0.rows(), 3);
  for (const ForceLaw& law : model_.laws) std::visit(AddSecantForces{model_.network, forms_, x0, x1, f}, law);
  hand_back(model_.network.cells.carried, f);
  return f;
}

}  // namespace springproof
