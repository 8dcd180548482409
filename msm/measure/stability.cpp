#include "msm/measure/stability.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "msm/algebra/dense.h"
#include "msm/models.h"
#include "msm/periodic/bulk_calibration.h"

namespace springproof {
namespace {

constexpr double round_off = 1e-7;  // of a multiple eigenvalue, relative to the largest

Eigen::MatrixXd dense_stiffness(const MassSpringModel& model) {
  const Tangent K = tangent(model, model.network.X);
  const Eigen::Index n = 3 * model.network.nodes();
  Eigen::MatrixXd A(n, n);
  Eigen::VectorXd column;
  for (Eigen::Index i = 0; i < n; ++i) {
    K.multiply(Eigen::VectorXd::Unit(n, i), column);
    A.col(i) = column;
  }
  return A;
}

/// Rows and columns of the in-plane unknowns.
Eigen::MatrixXd in_plane(const Eigen::MatrixXd& K) {
  const Eigen::Index nodes = K.rows() / 3;
  Eigen::MatrixXd A(2 * nodes, 2 * nodes);
  for (Eigen::Index i = 0; i < 2 * nodes; ++i)
    for (Eigen::Index j = 0; j < 2 * nodes; ++j) A(i, j) = K(3 * (i / 2) + i % 2, 3 * (j / 2) + j % 2);
  return A;
}

std::string stable_range_of_energy(const ModelParameters& p, const IsotropicMaterial& material) {
  const double q = bulk_calibration(p, material).q;
  if (!exact_volumes(p, material))
    return fmt::format(
        "on every network, as q = {:.4g} > -1/2 with weights kL: J^2 <= sum k L^2 sum k dL^2 at each node "
        "(Cauchy-Schwarz)",
        q);
  if (q > -1e-12)  // round-off of the formula at nu = 1/4
    return fmt::format(
        "on every network, as q = {:.4g} >= 0 with exact volumes, a sum of squares; so from nu = {:.4g}, the springs' "
        "own, up",
        q, springs_poisson_ratio(p));
  return fmt::format(
      "not proved: q = {:.4g} < 0 with exact volumes; inside lattices it is, elsewhere measured only (weights kL: "
      "proved)",
      q);
}

}  // namespace

BlockStability block_stability(const ModelParameters& parameters, const IsotropicMaterial& material, double cell_edge) {
  const bool planar = parameters.row.topology == Topology::hexagonal;
  const int n = planar || passes_patch_test(parameters.row) ? 6 : 3;  // fitted springs need nodes off the surface
  const int layers = planar ? 1 : n;
  const Mesh mesh = block_mesh(cell_edge * Vec3(n, n, layers), {n, n, layers});
  const MassSpringModel model = build_model(parameters, mesh, material);
  Eigen::MatrixXd K = dense_stiffness(model);
  if (planar) K = in_plane(K);
  BlockStability s{(K - K.transpose()).norm() / K.norm(), 1, 0};
  const Eigen::VectorXd mass = masses(model.network, material.density);
  const int axes = planar ? 2 : 3;
  for (Eigen::Index i = 0; i < K.rows(); ++i)
    for (Eigen::Index j = 0; j < K.cols(); ++j) K(i, j) /= std::sqrt(mass[i / axes] * mass[j / axes]);
  Eigen::VectorXcd values = s.asymmetry < 1e-13
                                ? Eigen::VectorXcd(symmetric_eigenvalues(K).cast<std::complex<double>>())
                                : Eigen::VectorXcd(K.eigenvalues());
  const double largest = values.cwiseAbs().maxCoeff();
  std::sort(values.begin(), values.end(), [](const auto& a, const auto& b) { return std::abs(a) < std::abs(b); });
  for (Eigen::Index i = planar ? 3 : 6; i < values.size(); ++i) {
    s.smallest_eigenvalue = std::min(s.smallest_eigenvalue, values[i].real() / largest);
    if (std::abs(values[i].imag()) > round_off * largest)
      s.flutter_damping =
          std::max(s.flutter_damping, values[i].real() > 0 ? std::abs(values[i].imag()) / std::sqrt(values[i].real())
                                                           : std::numeric_limits<double>::infinity());
  }
  return s;
}

std::string stable_range(const ModelParameters& p, const IsotropicMaterial& material) {
  if (p.has(Extension::volume_correction))
    return "-1 < nu < 1/2: every cell is positive (at A = 0: but for zero-energy modes)";
  if (p.has(Extension::angular_springs))
    return "-1 < nu_2D < 1 in its plane: a triangle strains affinely, K > 0 and G > 0 suffice";
  if (p.has(Extension::averaging)) return "-1 < nu < 1/2: every constant is positive";
  if (!p.has(Extension::momentum_dispersion)) return "never negative: springs alone are a sum of squares";
  if (has_energy(p.dispersion)) return stable_range_of_energy(p, material);
  if (p.row.topology == Topology::random || p.row.topology == Topology::hexagonal)
    return "no energy: not proved, measured only";
  if (std::isinf(p.face_to_cube))
    return "infinite lattice of 18 springs: real frequencies to nu = 0.46, positive real part to 0.4989 (Bloch waves); "
           "blocks: measured";
  if (p.face_to_cube == 0)
    return "infinite lattice of 14 springs: zero-energy mode; complex frequencies above nu = 1/4 (Bloch waves)";
  if (p.face_to_cube == 1)
    return "infinite lattice of 26 springs, A = 1: positive real part to nu = 0.4996 (Bloch waves); blocks: measured";
  return "no energy: not proved, measured only";
}

}  // namespace springproof
