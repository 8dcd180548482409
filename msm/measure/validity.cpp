#include "msm/measure/validity.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "msm/algebra/dense.h"
#include "msm/laws/capabilities.h"
#include "msm/measure/waves.h"
#include "msm/models.h"
#include "msm/periodic/bulk_calibration.h"
#include "msm/statics/equilibrium.h"

namespace springproof {
namespace {

/// A unit cell with free sides, stretched by `strain` along z.
Equilibrium stretched(const ModelParameters& parameters, const IsotropicMaterial& material, double strain) {
  const Mesh mesh = block_mesh(Vec3::Ones(), {1, 1, 1});
  const std::optional<double> free;
  const std::vector<Load> loads = {
      PrescribedDisplacement{"x_min", {0.0, free, free}}, PrescribedDisplacement{"y_min", {free, 0.0, free}},
      PrescribedDisplacement{"z_min", {free, free, 0.0}}, PrescribedDisplacement{"z_max", {free, free, strain}}};
  const LoadPath path = [&](double factor) {
    return transfer(loads, mesh, material.density, Kinematics::finite, factor);
  };
  NewtonOptions options;
  options.first_step = 0.02;
  return solve_finite(build_model(parameters, mesh, material), path, options);
}

/// hourglass corrections are for small displacements only; no effect in these states
ModelParameters without_corrections(ModelParameters p) {
  if (!p.has(Extension::averaging)) p.row.bending_correction = p.row.torsion_correction = false;
  return p;
}

double tension_limit(const ModelParameters& parameters, const IsotropicMaterial& material) {
  const double largest = 0.5;
  const Equilibrium e = stretched(parameters, material, largest);
  return e.ok ? std::numeric_limits<double>::infinity() : largest * e.load_reached;
}

/// The law as it is, by Newton's method on the lateral stretch; below nu = 0 there is no state far in compression.
std::optional<double> neo_hooke_stress(const IsotropicMaterial& m, double stretch) {
  const double G = shear_modulus(m), lambda = lame_lambda(m);
  const auto lateral = [&](double t) { return G * (t * t - 1) + lambda * std::log(stretch * t * t); };
  double t = std::pow(stretch, -m.poisson_ratio);
  for (int i = 0; i < 50; ++i) t -= lateral(t) / (2 * G * t + 2 * lambda / t);
  if (!(t > 0 && std::abs(lateral(t)) < 1e-9 * (G + std::abs(lambda)))) return {};
  return (G * (stretch * stretch - 1) + lambda * std::log(stretch * t * t)) / stretch;
}

/// The homogeneous states of a lattice stretched along z.
class Path {
 public:
  Path(const MassSpringModel& model, const IsotropicMaterial& m, Sides sides)
      : model_(model),
        sides_(sides),
        G_(shear_modulus(m)),
        round_off_(1e-13 * bulk_modulus(m)),
        unit_(G_ * model.network.cells.edge) {}

  /// The wave that grows at this strain (k = 0: no state, or one that gives way sideways); empty: it is stable.
  std::optional<Vec3> lost_at(double strain) {
    double across = across_;
    StrainedCell cell = at(strain, across);
    for (int i = 0; sides_ == Sides::free && i < 30; ++i) {
      const auto [along, other] = lateral(cell);
      if (!(along + other > 0)) return Vec3::Zero();
      const double step = -cell.stress(0, 0) / (along + other);
      across += std::clamp(step, -0.05, 0.05);
      cell = at(strain, across);
      if (std::abs(step) < 1e-12) break;
    }
    if (!cell.tangent.allFinite()) return Vec3::Zero();
    if (sides_ == Sides::free) {
      const auto [along, other] = lateral(cell);
      if (std::abs(cell.stress(0, 0)) > 1e-8 * G_ + round_off_ || along - std::abs(other) <= 0) return Vec3::Zero();
    }
    const SoftestWave weakest = weakest_wave(cell.tangent, unit_);
    if (weakest.stiffness < 1e-6) return weakest.k;
    across_ = across;
    stress_ = cell.stress(2, 2);
    return {};
  }

  /// Nominal, along z, of the last stable state [Pa].
  double stress() const { return stress_; }

 private:
  StrainedCell at(double strain, double across) const {
    return strained_cell(model_, Vec3(across, across, 1 + strain).asDiagonal());
  }

  /// dP_xx / dF_xx and dP_xx / dF_yy.
  std::pair<double, double> lateral(const StrainedCell& cell) const {
    CellVector x = CellVector::Zero(), y = CellVector::Zero();
    for (int n = 0; n < 8; ++n) {
      x[3 * n] = hexahedron_corners[n][0];
      y[3 * n + 1] = hexahedron_corners[n][1];
    }
    const double l = model_.network.cells.edge;
    return {x.dot(cell.tangent * x) / l, x.dot(cell.tangent * y) / l};
  }

  const MassSpringModel& model_;
  Sides sides_;
  double G_, round_off_, unit_;
  double stress_ = 0;
  double across_ = 1;  ///< stretch across z of the last stable state
};

}  // namespace

StrainLimits strain_limits(const ModelParameters& parameters, const IsotropicMaterial& material) {
  ModelParameters p = without_corrections(parameters);
  StrainLimits limits{};
  p.volume_energy = VolumeEnergy::bounded;
  limits.bounded_energy = tension_limit(p, material);
  p.volume_energy = VolumeEnergy::paper;
  limits.paper_energy = tension_limit(p, material);
  return limits;
}

std::vector<StressAtStretch> stress_curve(const ModelParameters& parameters, const IsotropicMaterial& m) {
  const ModelParameters p = without_corrections(parameters);
  std::vector<StressAtStretch> curve;
  const MassSpringModel lattice = build_model(p, block_mesh(Vec3::Ones(), {2, 2, 2}), m);
  const bool of_cells = can(lattice, Capability::equal_cells);
  for (const double stretch : {0.6, 0.7, 0.8, 0.9, 0.95, 1.05, 1.1, 1.2, 1.3, 1.4}) {
    StressAtStretch at{stretch, {}, m.youngs_modulus * std::log(stretch) / stretch, neo_hooke_stress(m, stretch)};
    const Equilibrium e = stretched(p, m, stretch - 1);
    if (e.ok) {
      at.model = e.support.col(2).tail<4>().sum();
    } else if (of_cells) {  // forces near nu = 1/2 are round-off of the volume term
      Path path(lattice, m, Sides::free);
      if (!path.lost_at(stretch - 1)) at.model = path.stress();
    }
    curve.push_back(at);
  }
  return curve;
}

std::optional<StrainLimit> strain_limit(const ModelParameters& parameters, const IsotropicMaterial& material,
                                        Sides sides, double strain) {
  const MassSpringModel model =
      build_model(without_corrections(parameters), block_mesh(Vec3::Ones(), {2, 2, 2}), material);
  if (!can(model, Capability::equal_cells))
    throw std::invalid_argument("homogeneous states are those of a lattice of cells");
  constexpr double precision = 1e-4;
  const double most = std::abs(strain), direction = strain < 0 ? -1 : 1;
  Path path(model, material, sides);
  double stable = 0, step = 0.02;
  std::optional<StrainLimit> limit;
  if (const auto k = path.lost_at(0)) return StrainLimit{0, *k};
  while (stable < most && step > precision) {
    const double next = std::min(most, stable + step);
    if (const auto k = path.lost_at(direction * next)) {
      limit = {direction * stable, *k};
      step /= 2;
    } else {
      stable = next;
    }
  }
  if (limit) limit->strain = direction * stable;
  return limit;
}

std::string describe_wave(const Vec3& k) {
  std::vector<std::string> axes;
  for (int axis = 0; axis < 3; ++axis)
    if (k[axis] > 0.5) axes.push_back(std::string(1, "xyz"[axis]));
  if (k.isZero()) return "the lattice gives way sideways";
  if (axes.empty()) return "waves of any length grow";
  return fmt::format("neighbours move against each other along {}", fmt::join(axes, " and "));
}

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
