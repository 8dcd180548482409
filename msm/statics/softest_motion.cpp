#include "msm/statics/softest_motion.h"

#include <cmath>
#include <limits>
#include <utility>

#include "msm/algebra/noise.h"

namespace springproof {
namespace {

constexpr int most_iterations = 30;
constexpr double settled = 1e-3;  // relative change of the stiffness

/// Per axis sum |u_j - u_i|^2 over sum |u_i|^2 + |u_j|^2 of the edges of all cells.
Vec3 alternation_of(const Network& network, const NodalVectors& u) {
  Vec3 change = Vec3::Zero(), size = Vec3::Zero();
  for (const Hexahedron& cell : network.cells.corners)
    for (int a = 0; a < 8; ++a)
      for (int b = a + 1; b < 8; ++b) {
        const auto &p = hexahedron_corners[a], &q = hexahedron_corners[b];
        const std::array<bool, 3> apart = {p[0] != q[0], p[1] != q[1], p[2] != q[2]};
        if (apart[0] + apart[1] + apart[2] != 1) continue;
        const int axis = apart[0] ? 0 : apart[1] ? 1 : 2;
        change[axis] += (u.row(cell[b]) - u.row(cell[a])).squaredNorm();
        size[axis] += u.row(cell[a]).squaredNorm() + u.row(cell[b]).squaredNorm();
      }
  return (size.array() > 0).select(change.cwiseQuotient(size), 0.0);
}

}  // namespace

SoftestMotion softest_motion(const MassSpringModel& model, const StiffnessSolver& K, const std::vector<char>& fixed) {
  const Tangent rest = tangent(model, model.network.X);
  Eigen::VectorXd u(static_cast<Eigen::Index>(fixed.size())), Ku, Ru;
  fill_with_noise(u);
  for (std::size_t i = 0; i < fixed.size(); ++i)
    if (fixed[i]) u[static_cast<Eigen::Index>(i)] = 0;
  double stiffness = std::numeric_limits<double>::infinity();
  for (int i = 0; i < most_iterations; ++i) {
    rest.multiply(u, Ru);
    Eigen::VectorXd next;
    if (!K.solve(Ru / Ru.norm(), 1e-4, 4000, next).converged) break;
    u = next / next.norm();
    K.multiply(u, Ku);
    rest.multiply(u, Ru);
    const double before = std::exchange(stiffness, u.dot(Ku) / u.dot(Ru));
    if (std::abs(stiffness - before) < settled * stiffness) break;
  }
  return {stiffness, alternation_of(model.network, Eigen::Map<const NodalVectors>(u.data(), u.size() / 3, 3))};
}

}  // namespace springproof
