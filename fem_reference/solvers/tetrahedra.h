// Matrix-free operators on straight-sided quadratic tetrahedra (small strain, one process).  Part of
// elastic_solver.cpp, like stiffness.h.
#pragma once

#include <array>
#include <stdexcept>
#include <vector>

#include "fem_reference/solvers/stiffness.h"
#include "fem_reference/system/elastic_system.h"

namespace springproof::fem::SPRINGPROOF_SOLVER_NAMESPACE {

constexpr int edge_corners[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};  ///< nodes 4 to 9, as in deal.II

// Cells, as many at a time as a vector has lanes, and what they do to displacements and pressures.
//
// Gradients of displacement are linear in a cell: the four-point rule of degree 2 integrates everything exactly.  With
// barycentric coordinates L_i of constant gradient g_i they are grad u = sum_j c_j g_j^T,
// c_j = (4 L_j - 1) u_j + 4 sum_(i != j) L_i u_ij.
template <typename Number>
class Tetrahedra {
 public:
  using Lane = Lanes<Number>;
  using Three = std::array<Lane, 3>;
  using Nodal = std::array<Three, 10>;  ///< displacements or forces of the nodes
  using Corners = std::array<Lane, 4>;  ///< pressures or dilatations of the corners

  struct Batch {
    std::array<Three, 3> g = {};  ///< of corners 1 to 3 [1/m]
    Lane weight = Number(0);      ///< a quarter of the volume [m^3]; 0 in lanes without a cell
    std::array<std::array<unsigned int, Lane::size()>, 10> node = {};   ///< first degree of freedom of the three
    std::array<std::array<unsigned int, Lane::size()>, 4> corner = {};  ///< degree of freedom of the pressure, if there
  };

  Tetrahedra(const dealii::DoFHandler<3>& displacement, const dealii::DoFHandler<3>* pressure) {
    std::size_t count = 0;
    for (const auto& cell : displacement.active_cell_iterators()) {
      const std::size_t lane = count++ % Lane::size();
      if (lane == 0) batches_.emplace_back();
      Batch& batch = batches_.back();
      place_nodes(displacement.get_fe(), dofs_in(cell, displacement), lane, batch);
      place_gradients(*cell, lane, batch);
      if (!pressure) continue;
      const auto p = dofs_in(cell, *pressure);
      for (int i = 0; i < 4; ++i) batch.corner[i][lane] = p[i];
    }
  }

  const std::vector<Batch>& batches() const { return batches_; }

  static Nodal read(const Batch& batch, const Vector<Number>& x) {
    Nodal u;
    for (int a = 0; a < 10; ++a)
      for (int c = 0; c < 3; ++c) u[a][c].gather(x.begin() + c, batch.node[a].data());
    return u;
  }
  static void add(const Batch& batch, const Nodal& f, Vector<Number>& y) {
    Number* const values = y.begin();
    for (int a = 0; a < 10; ++a)
      for (std::size_t lane = 0; lane < Lane::size(); ++lane)
        for (int c = 0; c < 3; ++c) values[batch.node[a][lane] + c] += f[a][c][lane];
  }
  static Corners read_corners(const Batch& batch, const Vector<Number>& x) {
    Corners p;
    for (int i = 0; i < 4; ++i) p[i].gather(x.begin(), batch.corner[i].data());
    return p;
  }
  static void add_corners(const Batch& batch, const Corners& r, Vector<Number>& y) {
    for (int i = 0; i < 4; ++i)
      for (std::size_t lane = 0; lane < Lane::size(); ++lane) y.local_element(batch.corner[i][lane]) += r[i][lane];
  }

  /// Calls stress_at(q, h): h, the gradient of displacement at point q, is to become the weighted stress there,
  /// symmetric. Returns the forces.
  template <typename StressAt>
  static Nodal forces(const Batch& batch, const Nodal& u, const StressAt& stress_at) {
    std::array<Three, 4> fixed, sum = {};  // the part of c_j that is the same at all points; its counterpart in forces
    Nodal f;
    for (int c = 0; c < 3; ++c) {
      for (int j = 0; j < 4; ++j) fixed[j][c] = Number(4 * outer - 1) * u[j][c];
      for (int e = 0; e < 6; ++e)
        for (const int j : edge_corners[e]) fixed[j][c] += Number(4 * outer) * u[4 + e][c];
    }
    for (int q = 0; q < 4; ++q) {
      std::array<Three, 4> at;  // c_j, then what multiplies it
      for (int j = 0; j < 4; ++j)
        for (int c = 0; c < 3; ++c) at[j][c] = fixed[j][c] + difference * u[between[q][j]][c];
      dealii::Tensor<2, 3, Lane> h;
      for (int j = 1; j < 4; ++j)
        for (int c = 0; c < 3; ++c) {
          const Lane d = at[j][c] - at[0][c];
          for (int k = 0; k < 3; ++k) h[c][k] += d * batch.g[j - 1][k];
        }
      stress_at(q, h);
      for (int c = 0; c < 3; ++c) {
        at[0][c] = Number(0);
        for (int j = 1; j < 4; ++j) {
          at[j][c] = h[c][0] * batch.g[j - 1][0] + h[c][1] * batch.g[j - 1][1] + h[c][2] * batch.g[j - 1][2];
          at[0][c] -= at[j][c];
        }
        for (int j = 0; j < 4; ++j) {
          sum[j][c] += at[j][c];
          Lane& there = f[between[q][j]][c];
          if (q <= j)
            there = difference * at[j][c];  // the first of the two points of an edge
          else
            there += difference * at[j][c];
        }
      }
    }
    for (int c = 0; c < 3; ++c) {
      for (int j = 0; j < 4; ++j) f[j][c] += Number(4 * outer - 1) * sum[j][c];
      for (int e = 0; e < 6; ++e)
        f[4 + e][c] += Number(4 * outer) * (sum[edge_corners[e][0]][c] + sum[edge_corners[e][1]][c]);
    }
    return f;
  }

  /// A linear function of these values in the corners, at point q.
  static Lane at_point(const Corners& p, int q) {
    return Number(outer) * (p[0] + p[1] + p[2] + p[3]) + Number(inner - outer) * p[q];
  }

  static constexpr double outer = 0.13819660112501052,
                          inner = 0.58541019662496845;  ///< (5 -+ sqrt 5) / 20, 1 - 3 outer

 private:
  static constexpr Number difference = Number(4 * (inner - outer));
  static constexpr int between[4][4] = {{0, 4, 6, 7}, {4, 1, 5, 8}, {6, 5, 2, 9}, {7, 8, 9, 3}};

  static void place_nodes(const dealii::FiniteElement<3>& fe, const std::vector<dealii::types::global_dof_index>& u,
                          std::size_t lane, Batch& batch) {
    for (unsigned int i = 0; i < u.size(); ++i) {
      const auto [component, node] = fe.system_to_component_index(i);
      if (component == 0) batch.node[node][lane] = u[i];
    }
    for (unsigned int i = 0; i < u.size(); ++i) {
      const auto [component, node] = fe.system_to_component_index(i);
      if (u[i] != batch.node[node][lane] + component)
        throw std::logic_error("the degrees of freedom of a node do not follow each other");
    }
  }

  template <typename Accessor>
  static void place_gradients(const Accessor& cell, std::size_t lane, Batch& batch) {
    dealii::Tensor<2, 3> J;  // columns: edges from corner 0
    for (int j = 0; j < 3; ++j)
      for (int c = 0; c < 3; ++c) J[c][j] = cell.vertex(j + 1)[c] - cell.vertex(0)[c];
    const dealii::Tensor<2, 3> inverse = invert(J);
    for (int j = 0; j < 3; ++j)
      for (int c = 0; c < 3; ++c) batch.g[j][c][lane] = Number(inverse[j][c]);
    batch.weight[lane] = Number(determinant(J) / 24);
  }

  std::vector<Batch> batches_;
};

template <typename Number>
class TetrahedraStiffness : public ConstrainedStiffness<TetrahedraStiffness<Number>, Number> {
 public:
  using Lane = Lanes<Number>;
  using Cells = Tetrahedra<Number>;

  TetrahedraStiffness(const ElasticSystem& system, double lambda)
      : cells_(system.dof_handler, nullptr), mu_(Number(system.mu)), lambda_(Number(lambda)) {
    this->rows_ = system.dof_handler.n_dofs();
    this->constrained_ = system.constrained;
  }

  Vector<Number> vector() const { return Vector<Number>(this->rows_); }

  // The internal force of every degree of freedom.
  void apply(Vector<Number>& y, const Vector<Number>& x) const {
    y = Number(0);
    for (const auto& batch : cells_.batches()) {
      const Lane mu = mu_ * batch.weight, lambda = lambda_ * batch.weight;
      const auto f = Cells::forces(batch, Cells::read(batch, x), [&](int, auto& h) {
        const Lane pressure = lambda * trace(h);
        h = mu * (h + transpose(h));
        for (int i = 0; i < 3; ++i) h[i][i] += pressure;
      });
      Cells::add(batch, f, y);
    }
  }

  // K_aa of node a, component c: integral of mu |grad N|^2 + (mu + lambda) (dN/dx_c)^2.
  Vector<Number> inverse_diagonal() const {
    Vector<Number> diagonal = vector();
    for (const auto& batch : cells_.batches()) Cells::add(batch, diagonal_of(batch), diagonal);
    for (const unsigned int i : this->constrained_) diagonal.local_element(i) = 1;
    for (Number& d : diagonal) d = 1 / d;
    return diagonal;
  }

 private:
  typename Cells::Nodal diagonal_of(const typename Cells::Batch& batch) const {
    typename Cells::Nodal d = {};
    for (int a = 0; a < 10; ++a)
      for (int q = 0; q < 4; ++q) {
        typename Cells::Three dN = {};
        const auto add = [&](double factor, int corner) {
          for (int c = 0; c < 3; ++c) {
            if (corner > 0) dN[c] += Number(factor) * batch.g[corner - 1][c];
            if (corner == 0) dN[c] -= Number(factor) * (batch.g[0][c] + batch.g[1][c] + batch.g[2][c]);
          }
        };
        const auto L = [&](int i) { return i == q ? Cells::inner : Cells::outer; };
        if (a < 4) {
          add(4 * L(a) - 1, a);
        } else {
          const auto [i, j] = edge_corners[a - 4];
          add(4 * L(i), j);
          add(4 * L(j), i);
        }
        const Lane all = dN[0] * dN[0] + dN[1] * dN[1] + dN[2] * dN[2];
        for (int c = 0; c < 3; ++c) d[a][c] += batch.weight * (mu_ * all + (mu_ + lambda_) * dN[c] * dN[c]);
      }
    return d;
  }

  Cells cells_;
  Number mu_, lambda_;
};

}  // namespace springproof::fem::SPRINGPROOF_SOLVER_NAMESPACE
