#include "msm/dynamics/terms/mass_average.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "msm/laws/capabilities.h"

namespace springproof {

Eigen::Matrix<double, 8, 8> consistent_mass(const FilledPart& part, double full) {
  Eigen::Matrix<double, 8, 8> C = Eigen::Matrix<double, 8, 8>::Zero();
  for (int q = 0; q < 8; ++q) {
    Eigen::Matrix<double, 8, 1> N;
    for (int a = 0; a < 8; ++a) {
      N[a] = 1;
      for (int d = 0; d < 3; ++d) {
        const double xi = part.mean[d] + (hexahedron_corners[q][d] == 0 ? -1 : 1) * std::sqrt(part.variance[d]);
        N[a] *= hexahedron_corners[a][d] == 0 ? 0.5 - xi : 0.5 + xi;
      }
    }
    C += full * part.fraction / 8 * N * N.transpose();
  }
  return C;
}

MassAverage::MassAverage(const Network& network, double theta, const Eigen::VectorXd& volumes)
    : theta_(theta), network_(&network) {
  if (!(theta >= 0 && theta <= 1))
    throw std::invalid_argument(fmt::format("share of consistent mass {:g} (allowed: 0 to 1)", theta));
  if (!acts()) return;
  if (const std::string why = lacks(network, Capability::mass_average); !why.empty())
    throw std::invalid_argument("a share of consistent mass does not suit this model: " + why);
  share_ = Eigen::VectorXd::Zero(network.nodes());
  for (int n = 0; n < network.nodes(); ++n)
    if (volumes[n] > 0) share_[n] = network.cells.volume() / 8 / volumes[n];
}

Eigen::Matrix<double, 8, 8> MassAverage::of_cell() { return 8 * consistent_mass(FilledPart{}, 1); }

NodalVectors MassAverage::velocities(const NodalVectors& s, const std::vector<char>& fixed) const {
  if (!acts()) return s;
  static const Eigen::Matrix<double, 8, 8> A = of_cell();
  NodalVectors v = s;
  for (std::size_t c = 0; c < network_->cells.size(); ++c) {
    const Hexahedron& cell = network_->cells.corners[c];
    Eigen::Matrix<double, 8, 3> of_corners;
    for (int a = 0; a < 8; ++a) of_corners.row(a) = s.row(cell[a]);
    const Eigen::Matrix<double, 8, 3> less = of_corners - A * of_corners;
    for (int a = 0; a < 8; ++a) v.row(cell[a]) += part(c) * share_[cell[a]] * less.row(a);
  }
  for (std::size_t i = 0; i < fixed.size(); ++i)
    if (fixed[i]) v.data()[i] = s.data()[i];
  return v;
}

NodalVectors MassAverage::momenta(const NodalVectors& v, const std::vector<char>& fixed) const {
  NodalVectors s = v;
  if (!acts()) return s;
  constexpr int most = 60;                                   // the error falls to a third or less each time
  const double relaxation = 2 / (1 + largest_gain(theta_));  // the best for eigenvalues from 1 to there
  for (int i = 0; i < most; ++i) {
    const NodalVectors change = relaxation * (v - velocities(s, fixed));
    s += change;
    if (change.norm() <= 1e-16 * s.norm()) break;
  }
  return s;
}

}  // namespace springproof
