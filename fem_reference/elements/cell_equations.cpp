#include "fem_reference/elements/cell_equations.h"

#include <limits>

namespace springproof::fem {
namespace {

using Matrix3d = Eigen::Matrix3d;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

// Material response at one quadrature point: stress S = S_shear + p Q, and its derivatives.
struct PointResponse {
  Matrix3d F;  // identity at small strain
  Voigt S, Q;
  Voigt G;    // dg / dE, for strains with engineering shears
  Matrix6 D;  // dS / dE at fixed p
};

double dilatation_at(const CellLaw& law, const Matrix3d& h) {
  return law.law ? dilatation(*law.law, Matrix3d::Identity() + h) : h.trace();
}

// `derivatives`: whether Q, G and D are wanted of a law of large strain too.
PointResponse respond_at(const CellLaw& law, const Matrix3d& h, double p, bool derivatives) {
  PointResponse r;
  if (!law.law) {
    const Matrix3d strain = (h + h.transpose()) / 2;
    r.F.setIdentity();
    r.Q << 1, 1, 1, 0, 0, 0;
    r.G = r.Q;
    r.S << strain(0, 0), strain(1, 1), strain(2, 2), strain(0, 1), strain(1, 2), strain(0, 2);
    r.S = 2 * law.mu * r.S + p * r.Q;
    r.D = law.mu * (Voigt() << 2, 2, 2, 1, 1, 1).finished().asDiagonal();
    return r;
  }
  r.F = Matrix3d::Identity() + h;
  if (!derivatives) {
    r.S = stress(*law.law, law.mu, p, r.F.transpose() * r.F);
    return r;
  }
  const LawResponse response = respond(*law.law, law.mu, p, r.F);
  return {r.F, response.S, response.Q, 2 * response.G, 2 * response.D};  // dC = 2 dE
}

ValueAndSlope pressure_of(const CellLaw& law, double g) {
  const double lambda = law.form == Form::mixed ? law.pointwise : law.lambda;
  if (!law.law) return {lambda * g, lambda};
  return pressure(*law.law, lambda, g);
}

ValueAndSlope dilatation_of(const CellLaw& law, double p) {
  const double lambda = law.lambda - law.pointwise;
  if (!law.law) return {p / lambda, 1 / lambda};
  return dilatation_at_pressure(*law.law, lambda, p);
}

// dE = B du, with engineering shears.
Eigen::Matrix<double, 6, Eigen::Dynamic> strain_matrix(const Matrix3d& F,
                                                       const Eigen::Ref<const Eigen::Matrix3Xd>& dN) {
  constexpr int pair[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}};
  Eigen::Matrix<double, 6, Eigen::Dynamic> B(6, 3 * dN.cols());
  for (int a = 0; a < dN.cols(); ++a)
    for (int s = 0; s < 6; ++s) {
      const auto [i, j] = pair[s];
      for (int c = 0; c < 3; ++c)
        B(s, 3 * a + c) = s < 3 ? F(c, i) * dN(i, a) : F(c, i) * dN(j, a) + F(c, j) * dN(i, a);
    }
  return B;
}

// Gradients at all quadrature points, or stresses there; 3 q + j, i: du_i/dX_j.
using PointTensors = Eigen::Matrix<double, Eigen::Dynamic, 3>;

// Column by column: for three of them Eigen's general product spends its time on packing.
PointTensors gradients_of(const CellShape& shape, const Eigen::MatrixXd& u) {
  PointTensors h(shape.gradients.rows(), 3);
  for (int i = 0; i < 3; ++i) h.col(i).noalias() = shape.gradients * u.col(i);
  return h;
}

// Forces of weighted first Piola-Kirchhoff stresses, each transposed.
void add_forces(const CellShape& shape, const PointTensors& stress, Eigen::MatrixXd& f) {
  for (int i = 0; i < 3; ++i) f.col(i).noalias() += shape.gradients.transpose() * stress.col(i);
}

// Displacement gradients, dilatations and pressures at all quadrature points.
struct PointStates {
  std::vector<Matrix3d> h;
  Eigen::VectorXd g, p, slope;  // slope: dp/dg
  Eigen::VectorXd unknown;      // of the mixed form: the part of p that is an unknown
  double smallest = std::numeric_limits<double>::infinity();
};

PointStates states(const CellLaw& law, const CellShape& shape, const CellVector& x) {
  PointStates s;
  const int n = shape.points();
  s.g.resize(n);
  s.p.resize(n);
  s.slope.resize(n);
  const auto h = gradients_of(shape, x.u);
  for (int q = 0; q < n; ++q) {
    s.h.emplace_back(h.middleRows<3>(3 * q).transpose());
    s.smallest = std::min(s.smallest, law.law ? (Matrix3d::Identity() + s.h[q]).determinant() : 1.0);
  }
  if (!(s.smallest > 0)) return s;
  for (int q = 0; q < n; ++q) s.g[q] = dilatation_at(law, s.h[q]);
  if (law.form == Form::mean_dilatation) s.g.setConstant(s.g.dot(shape.weights) / shape.weights.sum());
  for (int q = 0; q < n; ++q) {
    const ValueAndSlope p = pressure_of(law, s.g[q]);
    s.p[q] = p.value;
    s.slope[q] = p.slope;
  }
  if (law.form == Form::mixed) {
    s.unknown = shape.pressures * x.p;
    s.p += s.unknown;
  }
  return s;
}

// Mean of f over the straight line from a to b.
template <class T, class Function>
auto mean_over(const T& a, const T& b, const Function& f) {
  constexpr double at[2] = {0.33998104358485626, 0.86113631159405258},  // Gauss, four points
      weight[2] = {0.32607257743127307, 0.17392742256872693};
  const T middle = (a + b) / 2, half = (b - a) / 2;
  std::decay_t<decltype(f(a))> sum = weight[0] * (f(T(middle - at[0] * half)) + f(T(middle + at[0] * half)));
  sum += weight[1] * (f(T(middle - at[1] * half)) + f(T(middle + at[1] * half)));
  return sum;
}

// Geometric stiffness: grad N_a . S grad N_b, equal for the three components.
void add_stress_stiffness(const CellShape& shape, const std::vector<Matrix3d>& S, CellMatrix& K) {
  const int n = shape.nodes();
  Eigen::MatrixXd weighted(3 * shape.points(), n);
  for (int q = 0; q < shape.points(); ++q)
    weighted.middleRows<3>(3 * q) = shape.weights[q] * S[q] * shape.gradients.middleRows<3>(3 * q);
  const Eigen::MatrixXd s = shape.gradients.transpose() * weighted;
  for (int a = 0; a < n; ++a)
    for (int b = 0; b < n; ++b)
      for (int c = 0; c < 3; ++c) K(3 * a + c, 3 * b + c) += s(a, b);
}

// F in the middle of a step, and the change of the deviatoric strain over it, at all quadrature points.
struct ShearOfStep {
  std::vector<Matrix3d> F, change;

  ShearOfStep(const CellLaw& law, const CellShape& shape, const Eigen::MatrixXd& before,
              const Eigen::MatrixXd& middle) {
    const auto h = gradients_of(shape, middle), half = gradients_of(shape, middle - before);
    for (int q = 0; q < shape.points(); ++q) {
      F.push_back(Matrix3d::Identity());
      if (law.law) F[q] += h.middleRows<3>(3 * q).transpose();
      const Matrix3d product = F[q].transpose() * half.middleRows<3>(3 * q).transpose();
      change.push_back(product + product.transpose());  // exact: strain is quadratic
      change[q].diagonal().array() -= change[q].trace() / 3;
    }
  }
};

}  // namespace

double pointwise_part(bool tetrahedra, const CellLaw& law) {
  constexpr double over_mu = 4;
  return tetrahedra && law.law && law.form == Form::mixed ? over_mu * law.mu : 0;
}

bool any_mixed(const std::vector<CellLaw>& laws) {
  return std::any_of(laws.begin(), laws.end(), [](const CellLaw& law) { return law.form == Form::mixed; });
}

CellVector cell_residual(const CellLaw& law, const CellShape& shape, const CellVector& x, double& smallest,
                         CellTangent* tangent) {
  const int n = shape.nodes(), points = shape.points(), np = int(shape.pressures.cols());
  CellVector r{Eigen::MatrixXd::Zero(n, 3), Eigen::VectorXd::Zero(np)};
  const PointStates state = states(law, shape, x);
  smallest = std::min(smallest, state.smallest);
  if (!(state.smallest > 0)) return r;
  const bool idle = np > 0 && law.form != Form::mixed;  // pressures that are 0, of cells beside mixed ones
  CellMatrix compress;
  if (idle) {
    compress = -1 / law.mu * shape.pressures.transpose() * shape.weights.asDiagonal() * shape.pressures;
    r.p = compress * x.p;
  }

  Eigen::MatrixXd B, DB, QB, GB;
  if (tangent) {
    B.resize(6 * points, 3 * n);
    DB.resize(6 * points, 3 * n);
    QB.resize(points, 3 * n);
    GB.resize(points, 3 * n);
  }
  PointTensors stress(3 * points, 3);
  std::vector<Matrix3d> stresses;
  for (int q = 0; q < points; ++q) {
    const double w = shape.weights[q];
    const auto dN = shape.gradients.middleRows<3>(3 * q);
    const PointResponse response = respond_at(law, state.h[q], state.p[q], tangent != nullptr);
    const Matrix3d S = tensor(response.S);
    stress.middleRows<3>(3 * q) = w * S * response.F.transpose();
    if (law.form == Form::mixed)
      r.p += w * (state.g[q] - dilatation_of(law, state.unknown[q]).value) * shape.pressures.row(q).transpose();
    if (!tangent) continue;
    const auto b = strain_matrix(response.F, dN);
    stresses.push_back(law.law ? S : Matrix3d::Zero());
    B.middleRows<6>(6 * q) = b;
    DB.middleRows<6>(6 * q) = w * response.D * b;
    QB.row(q) = response.Q.transpose() * b;
    GB.row(q) = response.G.transpose() * b;
  }
  add_forces(shape, stress, r.u);
  if (!tangent) return r;

  tangent->uu = B.transpose() * DB;
  if (idle) {
    tangent->up = CellMatrix::Zero(3 * n, np);
    tangent->pu = CellMatrix::Zero(np, 3 * n);
    tangent->pp = compress;
  }
  if (law.law) add_stress_stiffness(shape, stresses, tangent->uu);
  const auto weights = shape.weights.asDiagonal();
  switch (law.form) {
    case Form::pointwise:
      tangent->uu += QB.transpose() * (shape.weights.cwiseProduct(state.slope).asDiagonal() * GB);
      break;
    case Form::mean_dilatation:
      tangent->uu += QB.transpose() * (weights * state.slope) * (shape.weights.transpose() * GB / shape.weights.sum());
      break;
    case Form::mixed: {
      if (law.pointwise > 0)
        tangent->uu += QB.transpose() * (shape.weights.cwiseProduct(state.slope).asDiagonal() * GB);
      Eigen::VectorXd compliance(points);
      for (int q = 0; q < points; ++q) compliance[q] = dilatation_of(law, state.unknown[q]).slope;
      tangent->up = QB.transpose() * (weights * shape.pressures);
      tangent->pu = shape.pressures.transpose() * (weights * GB);
      tangent->pp =
          -shape.pressures.transpose() * (shape.weights.cwiseProduct(compliance).asDiagonal() * shape.pressures);
      break;
    }
  }
  return r;
}

CellVector step_residual(const CellLaw& law, const CellShape& shape, const CellVector& before, const CellVector& middle,
                         double& smallest) {
  if (!law.law) return cell_residual(law, shape, middle, smallest, nullptr);
  const int points = shape.points(), np = int(shape.pressures.cols());
  CellVector r{Eigen::MatrixXd::Zero(shape.nodes(), 3), Eigen::VectorXd::Zero(np)};
  const CellVector after{2 * middle.u - before.u, 2 * middle.p - before.p};
  const PointStates first = states(law, shape, before), last = states(law, shape, after);
  smallest = std::min({smallest, first.smallest, last.smallest});
  if (!(smallest > 0)) return r;
  PointTensors stress(3 * points, 3);
  for (int q = 0; q < points; ++q) {
    const double w = shape.weights[q];
    double p = mean_over(first.g[q], last.g[q], [&](double at) { return pressure_of(law, at).value; });
    if (law.form == Form::mixed) {
      p += (first.unknown[q] + last.unknown[q]) / 2;
      r.p += w *
             ((first.g[q] + last.g[q]) / 2 -
              mean_over(first.unknown[q], last.unknown[q], [&](double at) { return dilatation_of(law, at).value; })) *
             shape.pressures.row(q).transpose();
    }
    const Matrix3d F0 = Matrix3d::Identity() + first.h[q], F1 = Matrix3d::Identity() + last.h[q];
    const Voigt S = mean_over(Matrix3d(F0.transpose() * F0), Matrix3d(F1.transpose() * F1),
                              [&](const Matrix3d& C) { return springproof::fem::stress(*law.law, law.mu, p, C); });
    stress.middleRows<3>(3 * q) = w / 2 * tensor(S) * (F0 + F1).transpose();
  }
  add_forces(shape, stress, r.u);
  return r;
}

double cell_energy(const CellLaw& law, const CellShape& shape, const CellVector& x) {
  const PointStates s = states(law, shape, x);
  double sum = 0;
  for (int q = 0; q < shape.points(); ++q) {
    const bool mixed = law.form == Form::mixed;
    double energy = shear_energy(*law.law, law.mu, Matrix3d::Identity() + s.h[q]) +
                    dilatation_energy(*law.law, mixed ? law.pointwise : law.lambda, s.g[q]);
    if (mixed) {
      const double g = dilatation_of(law, s.unknown[q]).value;
      energy += dilatation_energy(*law.law, law.lambda - law.pointwise, g) + s.unknown[q] * (s.g[q] - g);
    }
    sum += shape.weights[q] * energy;
  }
  return sum;
}

void add_viscosity(const CellLaw& law, const CellShape& shape, const Eigen::MatrixXd& u, const Eigen::MatrixXd& rate,
                   double viscosity, double per_rate, CellVector& residual, CellTangent* tangent) {
  const int n = shape.nodes(), points = shape.points();
  std::vector<Matrix3d> F(points), inverse(points);
  Eigen::VectorXd dilatation(points);  // its rate
  const auto h = gradients_of(shape, u), h_rate = gradients_of(shape, rate);
  PointTensors stress(3 * points, 3);
  for (int q = 0; q < points; ++q) {
    F[q] = Matrix3d::Identity();
    if (law.law) F[q] += h.middleRows<3>(3 * q).transpose();
    inverse[q] = F[q].inverse();
    const Matrix3d F_rate = h_rate.middleRows<3>(3 * q).transpose();
    dilatation[q] = (F_rate * inverse[q]).trace();
    const Matrix3d product = F[q].transpose() * F_rate;
    stress.middleRows<3>(3 * q) =
        viscosity * law.mu * shape.weights[q] * (product + product.transpose()) * F[q].transpose();
  }
  const auto weights = shape.weights.asDiagonal();
  const double scale = 1 + viscosity * per_rate;
  const double lambda = law.form == Form::mixed ? law.pointwise : law.lambda;
  if (law.form == Form::mixed)
    residual.p = (residual.p + viscosity * shape.pressures.transpose() * (weights * dilatation)) / scale;
  if (law.form == Form::mean_dilatation) dilatation.setConstant(dilatation.dot(shape.weights) / shape.weights.sum());
  for (int q = 0; q < points; ++q)
    stress.middleRows<3>(3 * q) += viscosity * lambda * dilatation[q] * shape.weights[q] * inverse[q];
  add_forces(shape, stress, residual.u);
  if (!tangent) return;

  Eigen::MatrixXd B(6 * points, 3 * n), DB(6 * points, 3 * n), traces(points, 3 * n);
  const Voigt shear = law.mu * (Voigt() << 2, 2, 2, 1, 1, 1).finished();
  for (int q = 0; q < points; ++q) {
    const auto dN = shape.gradients.middleRows<3>(3 * q);
    const auto b = strain_matrix(F[q], dN);
    B.middleRows<6>(6 * q) = b;
    DB.middleRows<6>(6 * q) = shape.weights[q] * shear.asDiagonal() * b;
    const Eigen::MatrixXd turned = inverse[q].transpose() * dN;
    traces.row(q) = Eigen::Map<const Eigen::VectorXd>(turned.data(), 3 * n).transpose();
  }
  tangent->uu += viscosity * per_rate * (B.transpose() * DB);
  if (law.form == Form::mixed) tangent->pp /= scale;
  if (law.form == Form::mean_dilatation)
    traces = (Eigen::VectorXd::Ones(points) * (shape.weights.transpose() * traces / shape.weights.sum())).eval();
  tangent->uu += viscosity * per_rate * lambda * (traces.transpose() * (weights * traces));
}

void add_relaxation(const CellLaw& law, const CellShape& shape, const Eigen::MatrixXd& before, const Eigen::MatrixXd& u,
                    const std::vector<RelaxingStep>& branches, const Overstrains& overstrains, CellVector& residual,
                    CellTangent* tangent) {
  const int n = shape.nodes(), points = shape.points();
  const ShearOfStep step(law, shape, before, u);
  PointTensors stress(3 * points, 3);
  for (int q = 0; q < points; ++q) {
    Matrix3d Q = Matrix3d::Zero();
    for (std::size_t i = 0; i < branches.size(); ++i)
      Q += branches[i].share * branches[i].over.mean(overstrains[branches.size() * q + i], step.change[q]);
    stress.middleRows<3>(3 * q) = 2 * law.mu * shape.weights[q] * Q * step.F[q].transpose();
  }
  add_forces(shape, stress, residual.u);
  if (!tangent) return;

  Matrix6 D = (Voigt() << 1, 1, 1, 0.5, 0.5, 0.5).finished().asDiagonal();
  D.topLeftCorner<3, 3>().array() -= 1. / 3;
  double modulus = 0;  // strain changes twice as much over the step as to its middle
  for (const RelaxingStep& branch : branches) modulus += 4 * law.mu * branch.share * branch.over.psi;
  Eigen::MatrixXd B(6 * points, 3 * n), DB(6 * points, 3 * n);
  for (int q = 0; q < points; ++q) {
    B.middleRows<6>(6 * q) = strain_matrix(step.F[q], shape.gradients.middleRows<3>(3 * q));
    DB.middleRows<6>(6 * q) = modulus * shape.weights[q] * D * B.middleRows<6>(6 * q);
  }
  tangent->uu += B.transpose() * DB;
}

void advance(const CellLaw& law, const CellShape& shape, const Eigen::MatrixXd& before, const Eigen::MatrixXd& u,
             const std::vector<RelaxingStep>& branches, Overstrains& overstrains) {
  const ShearOfStep step(law, shape, before, u);
  for (int q = 0; q < shape.points(); ++q)
    for (std::size_t i = 0; i < branches.size(); ++i) {
      Matrix3d& Q = overstrains[branches.size() * q + i];
      Q = branches[i].over.end(Q, step.change[q]).eval();
    }
}

CellMatrix cell_stiffness(const CellLaw& law, const CellShape& shape, const Eigen::MatrixXd* u) {
  const int n = shape.nodes(), points = shape.points();
  // One column per point: the gradients of all shape functions, weighted so that X X^T integrates their products.
  Eigen::MatrixXd X(3 * n, points);
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(3 * n);
  for (int q = 0; q < points; ++q) {
    Eigen::Matrix3Xd dN = shape.gradients.middleRows<3>(3 * q);
    if (u) {
      const Matrix3d F = Matrix3d::Identity() + u->transpose() * dN.transpose();
      if (F.determinant() > 0.05) dN = F.inverse().transpose() * dN;
    }
    const Eigen::Map<const Eigen::VectorXd> all(dN.data(), 3 * n);
    X.col(q) = std::sqrt(shape.weights[q]) * all;
    mean += shape.weights[q] * all;
  }
  const Eigen::MatrixXd M = X * X.transpose();
  const double lambda = law.form == Form::pointwise ? law.lambda : law.pointwise;
  CellMatrix K = CellMatrix::Zero(3 * n, 3 * n);
  for (int a = 0; a < n; ++a)
    for (int b = 0; b < n; ++b) {
      const Matrix3d m = M.block<3, 3>(3 * a, 3 * b);
      K.block<3, 3>(3 * a, 3 * b) = law.mu * (m.transpose() + m.trace() * Matrix3d::Identity());
      K.block<3, 3>(3 * a, 3 * b) += lambda * m;
    }
  if (law.form == Form::mean_dilatation) K += law.lambda / shape.weights.sum() * mean * mean.transpose();
  return K;
}

}  // namespace springproof::fem
