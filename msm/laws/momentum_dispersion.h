// Force law: momentum dispersion of eMSM, which gives springs any Poisson's ratio.  Kot & Nagahashi (2015), sec. 3-5.
#pragma once

#include <array>
#include <vector>

#include "msm/algebra/tangent.h"
#include "msm/laws/law_traits.h"
#include "msm/laws/strain_energy.h"
#include "msm/topology/network.h"

namespace springproof {

/// Inflow of a node from its springs, J_n = sum_s a_sn dL_s, and the tension that its outflow adds to each,
/// T_s += c_si J_i + c_sj J_j (s = (i, j), k spring constant, L rest length, dL elongation, b springs at the node).
enum class Dispersion {
  symmetric,       ///< a = w, c = q w / sum_n w L: the gradient of an energy; w = k L, or given per spring end
  share_weighted,  ///< a = q k L, c = share / (L sum_n share): the paper's form, correct at the surface of a lattice
  published,       ///< a = q k L, c = 1 / (b L): Kot & Nagahashi (2015), sec. 4
  published_transposed,  ///< a = q k / L, c = L / b: the paper's other form, for lattices of 18 springs only
  finite_strain,         ///< symmetric at small strain; at large strain a material law (nodal_gradients.h)
};
constexpr std::array<const char*, 5> names_of(Dispersion) {
  return {"symmetric", "share_weighted", "published", "published_transposed", "finite_strain"};
}

/// Whether the forces of a form derive from an energy.
inline bool has_energy(Dispersion form) { return form == Dispersion::symmetric || form == Dispersion::finite_strain; }

/// A node takes in a fraction of what stretches the springs around it, and gives it back to them as tension.
struct MomentumDispersion {
  /// What solvers, kernels and the time step use of this law.
  static constexpr LawTraits traits = {
      "momentum dispersion",
      Reach::second_neighbours,
      {Capability::lattice_kernels, Capability::list_kernels, Capability::list_stiffness, Capability::energy_momentum}};

  /// Why it cannot what its traits say, with these parameters; nullptr: it can (law_traits.h).
  const char* lacks(Capability what) const;

  double q = 0;                             ///< Q / 2, the fraction of the incoming force that a node disperses
  Dispersion form = Dispersion::symmetric;  ///< which inflow and outflow
  /// With an energy: w [N] per spring end, i then j; empty: k L.  Share-weighted: each spring's share of the full
  /// spring; empty: 1.
  std::vector<double> weight = {};
  /// Per node, the node whose J receives its springs' inflow; empty: its own.  Forms with an energy only.
  std::vector<int> group = {};
  StrainCurve curve = StrainCurve::hencky;  ///< the material law of finite strain

  /// Names the parameters, for springs files (law_traits.h).
  template <class Fields>
  void fields(Fields& f) {
    f.number("q", q);
    f.choice("form", form);
    if (form == Dispersion::finite_strain) f.choice("curve", curve);
    f.of_springs("weight", weight);
    f.of_nodes("group", group);
  }

  /// Whether a material law at the nodes has taken the place of the dispersed elongations, in finite strain with given
  /// weights; inflow() and tensions() then hold at small strain only.
  bool of_volumes() const { return form == Dispersion::finite_strain && !weight.empty(); }

  double energy(const Network& network, const NodalVectors& x) const;  ///< [J]; 0 for non-conservative forms
  void add_forces(const Network& network, const NodalVectors& x, NodalVectors& f) const;  ///< [N]
  void add_tangent(const Network& network, const NodalVectors& x,
                   BlockMatrix& K) const;  ///< the part between connected nodes

  /// The rest of the tangent, outflow^T inflow.
  void add_flow(const Network& network, const NodalVectors& x, Tangent& K) const;

  /// J_n at positions x; periodic images contribute to the J of their master.
  Eigen::VectorXd inflow(const Network& network, const NodalVectors& x) const;
  /// Adds the forces of given inflows at x.
  void add_forces(const Network& network, const NodalVectors& x, const Eigen::VectorXd& J, NodalVectors& f) const;
  /// Coefficients of inflow and outflow per spring and end, i then j.
  struct Coefficients {
    std::vector<std::array<double, 2>> in;   ///< a_si, a_sj
    std::vector<std::array<double, 2>> out;  ///< c_si, c_sj
  };
  /// Those of a network at rest.
  Coefficients coefficients(const Network& network) const;

  /// The node whose J the springs at a node add to.
  int sink(const Network& network, int node) const {
    return group.empty() ? network.master(node) : group[network.master(node)];
  }

  /// The tension that given inflows add to each spring [N].
  std::vector<double> tensions(const Network& network, const Eigen::VectorXd& J) const;

  /// Per spring k (R_i + R_j) [N/m], so that v . K v <= sum_s k (R_i + R_j) (n . dv)^2 for every motion v, K the
  /// stiffness at rest.  By Cauchy and Schwarz over the springs of a node R_n = (|a| |c| + a . c) / 2, a . c = sum a c
  /// / k: q of the symmetric form with w = k L, or 0 if q is negative.  `of_size`: |v . K v|, R_n = |a| |c|.
  std::vector<double> stiffness_bound(const Network& network, bool of_size) const;
};

/// q = Q / 2 of Kot & Nagahashi (2015), eqs. (9), (36), for a Poisson's ratio in d dimensions:
/// Q = (lambda - mu) / ((1 + 2/d) mu).
double dispersed_fraction(double lame_lambda, double shear_modulus, int dimensions = 3);

/// The inverse: lambda added by dispersion, divided by G.
double added_lambda(const MomentumDispersion& law, int dimensions = 3);

/// Share of each spring of a superposed lattice in the stiffness of the full spring of its length inside, 0 < share <=
/// 1.
std::vector<double> spring_shares(const Network& network);

}  // namespace springproof
