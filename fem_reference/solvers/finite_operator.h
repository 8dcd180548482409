// Matrix-free finite-strain residual and tangent, total Lagrangian.  Part of elastic_solver.cpp, like stiffness.h.
#pragma once

#include <limits>

#include "fem_reference/elements/laws.h"
#include "fem_reference/solvers/mixed_operator.h"

namespace springproof::fem::SPRINGPROOF_SOLVER_NAMESPACE {

// Internal force from P = F S, S = S_shear + p Q.  The pressure p follows from the dilatation g at the quadrature point
// or from its mean over the cell, or is an unknown; then the residual also contains the integrals of (g - g(p)) q.
template <int degree>
class FiniteOperator : public OperatorWithPressures<degree, FiniteOperator<degree>> {
  using Shared = OperatorWithPressures<degree, FiniteOperator<degree>>;
  using Shared::base_, Shared::pressure_, Shared::mixed, Shared::form_, Shared::lambda_;
  using typename Shared::Cell, typename Shared::Lane, typename Shared::Pressures;
  using Tensor = dealii::Tensor<2, 3, Lane>;
  using Six = std::array<Lane, 6>;
  static constexpr unsigned int points = Cell::static_n_q_points;

 public:
  FiniteOperator(const ElasticSystem& system, Law law)
      : Shared(system, {system.mu, 0, false}),
        law_(law),
        mu_(system.mu),
        table_(base_.cells().n_cell_batches() * points * entries * Lane::size()) {}

  void prepare(const MixedField& x) { this->multigrid_.deform(x.u); }

  /// Residual at x, on all degrees of freedom, and the tangent that vmult uses from then on.  Returns the
  /// smallest det F at quadrature points; f and the tangent are valid only if it is positive.
  double linearise(MixedField& f, const MixedField& x) {
    double smallest = std::numeric_limits<double>::infinity();
    this->loop(f, x, [&](Cell& u, unsigned int batch, const Pressures& p) { return evaluate(u, batch, p, smallest); });
    return dealii::Utilities::MPI::min(smallest, base_.cells().get_dof_handler().get_communicator());
  }

  /// Tangent times x, on all degrees of freedom.
  void apply(MixedField& y, const MixedField& x) const {
    this->loop(y, x, [&](Cell& u, unsigned int batch, const Pressures& p) { return tangent(u, batch, p); });
  }

  /// f = the forces of increments of pressure alone, where not constrained.
  void couple(Vector<double>& f, const Vector<double>& p) const {
    MixedField x = this->vector(), y = x;
    x.p = p;
    this->vmult(y, x);
    f = y.u;
  }

 private:
  static constexpr int entries = 9 + 6 + 6 + 6 + 36 + 1;  // F, S, Q, G, D, slope of p(g) or g(p)

  using AtPoints = std::array<Lane, points>;

  // Replaces g by its mean over the cell in the mean-dilatation form.
  void average(const Cell& u, AtPoints& g) const {
    if (form_ != Form::mean_dilatation) return;
    Lane sum = 0., volume = 0.;
    for (unsigned int q = 0; q < points; ++q) {
      sum += g[q] * u.JxW(q);
      volume += u.JxW(q);
    }
    g.fill(sum / volume);
  }

  // Adds the contribution of point q to the integrals of `excess` times the pressure functions.
  void test(const Cell& u, unsigned int q, const Lane& excess, Pressures& r) const {
    for (int f = 0; f < pressure_.functions; ++f) r[f] += pressure_.basis[f][q] * excess * u.JxW(q);
  }

  static Eigen::Matrix3d lane_of(const Tensor& F, std::size_t lane) {
    Eigen::Matrix3d f;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) f(i, j) = F[i][j][lane];
    return f;
  }

  Pressures evaluate(Cell& u, unsigned int batch, const Pressures& p, double& smallest) {
    std::array<Tensor, points> F;
    AtPoints g{};
    for (unsigned int q = 0; q < points; ++q) {
      F[q] = u.get_gradient(q);
      for (int i = 0; i < 3; ++i) F[q][i][i] += 1.;
      for (std::size_t lane = 0; lane < Lane::size(); ++lane) {
        const Eigen::Matrix3d f = lane_of(F[q], lane);
        smallest = std::min(smallest, f.determinant());
        if (smallest > 0) g[q][lane] = dilatation(law_, f);
      }
    }
    average(u, g);
    Pressures r{};
    for (unsigned int q = 0; q < points && smallest > 0; ++q) {
      Lane at = pressure_.value(p, q), excess = 0.;
      Tensor S;
      for (std::size_t lane = 0; lane < Lane::size(); ++lane) {
        const ValueAndSlope other =
            mixed() ? dilatation_at_pressure(law_, lambda_, at[lane]) : pressure(law_, lambda_, g[q][lane]);
        if (mixed())
          excess[lane] = g[q][lane] - other.value;
        else
          at[lane] = other.value;
        set_lane(lane, F[q], respond(law_, mu_, at[lane], lane_of(F[q], lane)), other.slope, entry(batch, q), S);
      }
      if (mixed()) test(u, q, excess, r);
      u.submit_gradient(F[q] * S, q);
    }
    return r;
  }

  // Stores the tangent in single precision: it affects only the convergence of Newton's method, not the solution.
  void set_lane(std::size_t lane, const Tensor& F, const LawResponse& response, double slope, float* to,
                Tensor& S) const {
    constexpr int index[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
    const auto put = [&](double value) {
      to[lane] = float(value);
      to += Lane::size();
    };
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        S[i][j][lane] = response.S[index[i][j]];
        put(F[i][j][lane]);
      }
    for (const double s : response.S) put(s);
    for (const double s : response.Q) put(s);
    for (const double s : response.G) put(s);
    for (const auto& row : response.D.rowwise())
      for (const double d : row) put(d);
    put(slope);
  }

  // dP = h S + F (D dC + Q dp), dC = h^T F + F^T h
  Pressures tangent(Cell& u, unsigned int batch, const Pressures& p) const {
    AtPoints dg;
    std::array<Six, points> dC;
    for (unsigned int q = 0; q < points; ++q) {
      const float* from = entry(batch, q);
      const Tensor F = read_F(from);
      const Tensor h = u.get_gradient(q);
      const Tensor Fh = dealii::transpose(F) * h;
      dC[q] = {2. * Fh[0][0],
               2. * Fh[1][1],
               2. * Fh[2][2],
               2. * (Fh[0][1] + Fh[1][0]),
               2. * (Fh[1][2] + Fh[2][1]),
               2. * (Fh[0][2] + Fh[2][0])};
      dg[q] = 0.;
      const Six G = read_six(from + 21 * Lane::size());
      for (int i = 0; i < 6; ++i) dg[q] += G[i] * dC[q][i];
    }
    average(u, dg);
    Pressures r{};
    for (unsigned int q = 0; q < points; ++q) {
      const float* from = entry(batch, q);
      const Lane slope = widen(from + 63 * Lane::size());
      const Lane dp = mixed() ? pressure_.value(p, q) : slope * dg[q];
      if (mixed()) test(u, q, dg[q] - slope * dp, r);
      const Six S = read_six(from + 9 * Lane::size()), Q = read_six(from + 15 * Lane::size());
      Six dS;
      for (int i = 0; i < 6; ++i) {
        dS[i] = Q[i] * dp;
        const Six D = read_six(from + (27 + 6 * i) * Lane::size());
        for (int j = 0; j < 6; ++j) dS[i] += D[j] * dC[q][j];
      }
      u.submit_gradient(u.get_gradient(q) * symmetric(S) + read_F(from) * symmetric(dS), q);
    }
    return r;
  }

  static Lane widen(const float* from) {
    Lane v;
    for (std::size_t lane = 0; lane < Lane::size(); ++lane) v[lane] = from[lane];
    return v;
  }

  static Tensor read_F(const float* from) {
    Tensor F;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) F[i][j] = widen(from + (3 * i + j) * Lane::size());
    return F;
  }

  static Six read_six(const float* from) {
    Six v;
    for (int i = 0; i < 6; ++i) v[i] = widen(from + i * Lane::size());
    return v;
  }

  static Tensor symmetric(const Six& v) {
    Tensor t;
    t[0][0] = v[0], t[1][1] = v[1], t[2][2] = v[2];
    t[0][1] = t[1][0] = v[3];
    t[1][2] = t[2][1] = v[4];
    t[0][2] = t[2][0] = v[5];
    return t;
  }

  std::size_t position(unsigned int batch, unsigned int q) const {
    return (std::size_t(batch) * points + q) * entries * Lane::size();
  }
  const float* entry(unsigned int batch, unsigned int q) const { return table_.data() + position(batch, q); }
  float* entry(unsigned int batch, unsigned int q) { return table_.data() + position(batch, q); }

  Law law_;
  double mu_;
  std::vector<float> table_;  // per batch, quadrature point, entry and lane
};

}  // namespace springproof::fem::SPRINGPROOF_SOLVER_NAMESPACE
