#include "msm/dynamics/natural_modes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "msm/algebra/fixed.h"
#include "msm/algebra/lobpcg.h"
#include "msm/algebra/noise.h"
#include "msm/dynamics/terms/mass_average.h"
#include "msm/embedding/boundary.h"
#include "msm/embedding/rigid_motions.h"
#include "msm/laws/capabilities.h"
#include "msm/statics/stiffness_solver.h"
#include "problem/processes/child.h"
#include "problem/system/run_cost.h"

namespace springproof {
namespace {

constexpr long modes_direct_limit = 6000;  // free unknowns; one factorisation serves some hundred solutions
constexpr int guards = 8;                  // modes computed beside those wanted: a cube has up to six of one frequency
constexpr double mode_tolerance = 1e-6;    // residual; frequencies are then exact to its square or better
constexpr double inner_residual = 1e-2;    // of the preconditioning solve
constexpr int inner_iterations = 100, outer_iterations = 60;

/// Rigid motions that the supports leave, as columns over all unknowns; 0 where there is no equation.
Eigen::MatrixXd left_motions(const std::vector<char>& fixed, const std::vector<char>& none, const NodalVectors& X) {
  const RigidMotions rigid{X};
  const auto motions = free_motions(fixed, rigid);
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(none.size()), motions.cols());
  for (int i = 0; i < static_cast<int>(none.size()); ++i)
    if (!none[i]) columns.row(i) = rigid.at(i).transpose() * motions;
  return columns;
}

/// Repeatable, different in every entry.
Eigen::MatrixXd scattered(Eigen::Index rows, Eigen::Index columns) {
  Eigen::MatrixXd X(rows, columns);
  fill_with_noise(X.reshaped());
  return X;
}

void compute(const MassSpringModel& model, const std::vector<char>& supported, double density, double theta, int count,
             NaturalModes& modes) {
  const Network& network = model.network;
  const std::vector<char> fixed = fixed_or_carried(network, supported);
  const Eigen::SparseMatrix<double> mass = mass_matrix(network, density, theta);
  // Residuals are in equilibrium with themselves: held at just enough unknowns, a body answers them without reactions.
  BoundaryConditions held;
  held.fixed = supported;
  hold_free_motions(network.X, held, network.cells.carried);
  const auto stiffness = solver_for(model, fixed_or_carried(network, held.fixed), modes_direct_limit);
  modes.solver = "LOBPCG + " + stiffness->name();
  if (!stiffness->take(network.X)) {
    modes.message = "the stiffness at rest is not positive definite: the model has zero-energy or unstable modes";
    return;
  }
  const Operator K = [&](const Eigen::VectorXd& x, Eigen::VectorXd& y) {
    stiffness->multiply(x, y);
    clear_fixed(fixed, y);
  };
  const Operator M = [&](const Eigen::VectorXd& x, Eigen::VectorXd& y) {
    y.resize(x.size());
    by_point(y) = mass * by_point(x);
    clear_fixed(fixed, y);
  };
  const Operator solve = [&](const Eigen::VectorXd& r, Eigen::VectorXd& z) {
    if (children_interrupted()) throw std::runtime_error("interrupted");
    stiffness->solve(r, inner_residual, inner_iterations, z);
  };
  const Eigen::MatrixXd rigid = orthonormalised(M, left_motions(supported, fixed, network.X), {});
  const long unknowns = std::count(fixed.begin(), fixed.end(), 0) - rigid.cols();
  const auto wanted = static_cast<int>(std::min<long>(count, unknowns));
  Eigen::MatrixXd start = scattered(3 * network.X.rows(), std::min<long>(wanted + guards, unknowns));
  Eigen::VectorXd y, inertia, z;
  for (Eigen::Index j = 0; j < start.cols(); ++j) {  // the answers to scattered loads in equilibrium: smooth
    M(start.col(j), y);
    M(rigid * (rigid.transpose() * y), inertia);
    solve(y - inertia, z);
    start.col(j) = z;
  }
  const SmallestEigenpairs found =
      smallest_eigenpairs(K, M, solve, rigid, start, wanted, mode_tolerance, outer_iterations);
  modes.rigid_motions = static_cast<int>(rigid.cols());
  modes.iterations = found.iterations;
  modes.residual = found.residual;
  modes.ok = found.converged && found.values.size() > 0 && found.values[0] > 0;
  if (!modes.ok)
    modes.message =
        fmt::format("{}: residual {:.2e} after {} iterations", modes.solver, found.residual, found.iterations);
  for (int j = 0; modes.ok && j < wanted; ++j) {
    modes.frequencies.push_back(std::sqrt(found.values[j]) / (2 * std::numbers::pi));
    carry(network.cells.carried,
          modes.shapes.emplace_back(Eigen::Map<const NodalVectors>(found.vectors.col(j).data(), network.X.rows(), 3)));
  }
}

}  // namespace

Eigen::SparseMatrix<double> mass_matrix(const Network& network, double density, double theta) {
  if (!(theta >= 0 && theta <= 1))
    throw std::invalid_argument(fmt::format("share of consistent mass {:g} (allowed: 0 to 1)", theta));
  std::vector<Eigen::Triplet<double>> entries;
  const Carriers carriers = carriers_of(network.nodes(), network.cells.carried);
  for (std::size_t c = 0; c < network.cells.size(); ++c) {
    const Hexahedron& cell = network.cells.corners[c];
    const std::vector<double>& of = network.cells.relative_densities;
    const double own = of.empty() ? density : density * of[network.cells.material(c)];
    const auto C = consistent_mass(network.cells.part(c), own * std::pow(network.cells.edge_of(c), 3));
    for (int a = 0; a < 8; ++a)
      for_each_carrier(carriers, cell[a], [&](int i, double v) {
        entries.emplace_back(i, i, (1 - theta) * v * C.row(a).sum());
        for (int b = 0; theta > 0 && b < 8; ++b)
          for_each_carrier(carriers, cell[b],
                           [&](int j, double w) { entries.emplace_back(i, j, theta * v * w * C(a, b)); });
      });
  }
  const Eigen::VectorXd lumped = network.cells.empty() ? masses(network, density) : network.attached;
  for (int n = 0; n < lumped.size(); ++n) entries.emplace_back(n, n, lumped[n]);
  Eigen::SparseMatrix<double> mass(network.nodes(), network.nodes());
  mass.setFromTriplets(entries.begin(), entries.end());
  return mass;
}

NaturalModes natural_modes(const MassSpringModel& model, const std::vector<char>& fixed, double density, double theta,
                           int count) {
  const double start = cpu_seconds();
  NaturalModes modes;
  if (!can(model, Capability::energy))
    modes.message = "its forces have no potential, so it has no natural modes (allowed: symmetric dispersion)";
  else
    compute(model, fixed, density, theta, count, modes);
  modes.seconds = cpu_seconds() - start;
  return modes;
}

}  // namespace springproof
