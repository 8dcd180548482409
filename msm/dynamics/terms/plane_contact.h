// Contact of a moving network with a rigid plane, by impulses on points that its nodes carry.
#pragma once

#include <Eigen/SparseCore>
#include <optional>
#include <vector>

#include "msm/algebra/block_matrix.h"
#include "problem/plane.h"
#include "problem/vector.h"

namespace springproof {

/// The first time that a body touches the plane, as a whole.
struct Bounce {
  double begin = 0, end = 0;                       ///< [s]
  double velocity_before = 0, velocity_after = 0;  ///< of the centre of mass along the normal [m/s]
};

/// What the plane gave the body.
struct ContactImpulse {
  Vec3 linear = Vec3::Zero();   ///< [N s]
  Vec3 angular = Vec3::Zero();  ///< about the origin [N m s]

  /// Adds an impulse [N s] at a point.
  void add(const Vec3& impulse, const Vec3& at);
};

/// Points that nodes carry, x_p = sum_n w_pn x_n: points x nodes, rows sum to 1.
using PointWeights = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// After an explicit step every point of the body that has passed the plane is put onto it or before it, by impulses
/// that give it the velocity to arrive there (Carpenter et al. 1991: Lagrange multipliers of the positions at the end
/// of the step).  The points are nodes, or carried by nodes, which take the impulse by the same weights: momenta change
/// by exactly what the plane gives.  Points that share nodes couple: with the operator G = W M^-1 W^T of the points and
/// the velocity g = -distance/dt that each lacks along the normal,
///   0 <= p,  0 <= G p - g,  p . (G p - g) = 0,
/// by projected Gauss-Seidel, which for nodes, where G is diagonal, is exact at once.  Friction takes an impulse of up
/// to the coefficient times p from the point's motion along the plane.  A node that lands loses its velocity along the
/// normal, so that an elastic body loses the kinetic energy of one layer of nodes: less on finer lattices.  The time
/// step is bounded as without the plane.
class PlaneContact {
 public:
  /// @param plane that the body stays on one side of
  /// @param mass of each node [kg]
  /// @param pause contacts that are this far apart belong to two bounces [s]
  /// @param points of the body's surface; empty: the nodes
  PlaneContact(const Plane& plane, const Eigen::VectorXd& mass, double pause, PointWeights points = {});

  const Plane& plane() const { return plane_; }
  bool of_nodes() const { return of_nodes_; }  ///< the points are the nodes

  /// Corrects the state at the end of a step of dt.
  /// @param damping of the step, (1 + damping dt) v1 = v0 + dt f/m, which takes its part of the impulses [1/s]
  /// @param fixed unknowns, three of each node: a node with any takes no impulse
  /// @return whether anything was changed
  bool correct(double dt, double damping, const std::vector<char>& fixed, NodalVectors& x, NodalVectors& v);

  /// Counts an impulse that the body got otherwise, in a large step that ends on the plane.
  void count(const ContactImpulse& further);

  /// To be called at the start and after every step, for the bounce.
  /// @param v velocities of the nodes [m/s]
  void observe(double time, const NodalVectors& v);

  /// Velocities with which no point that touched the plane at the end of the last step enters it.
  NodalVectors stopped(const std::vector<char>& fixed, NodalVectors v) const;

  /// What the body got since the last call.
  ContactImpulse take_impulse();

  /// The first one; empty: it has not begun, or has not ended.
  std::optional<Bounce> bounce() const;

 private:
  /// A point that touches the plane.
  struct Touch {
    int point;
    double mobility;  ///< G_pp [1/kg]
    double velocity;  ///< along the normal, that it is to have or exceed [m/s]
    Vec3 impulse;     ///< [N s]
  };
  using Touching = std::vector<Touch>;
  Eigen::VectorXd mobilities(const std::vector<char>& fixed) const;
  Vec3 at(int point, const NodalVectors& of_nodes) const;
  void push(int point, const Vec3& impulse, const Eigen::VectorXd& inverse_mass, NodalVectors& v) const;
  void add(int point, double velocity, const Eigen::VectorXd& inverse_mass, Touching& touching) const;
  void solve(double friction, const Eigen::VectorXd& inverse_mass, Touching& touching, NodalVectors& v) const;

  Plane plane_;
  Eigen::VectorXd mass_;
  double pause_;
  bool of_nodes_;
  PointWeights points_;
  NodalVectors latest_;  ///< impulse on each point at the end of the last step [N s]
  ContactImpulse impulse_;
  bool touches_ = false;  ///< since observe()
  double velocity_ = 0;   ///< of the centre of mass then, along the normal [m/s]
  std::optional<Bounce> first_;
  bool ended_ = false;
};

/// The nodes that end a step on a plane.  A step is solved with them on it, free to slide; those whose reaction would
/// pull are then released, those behind the plane held, and the step is solved anew until there are none of either:
///   x_n >= 0,  r_n >= 0,  x_n r_n = 0
/// of the distance x_n and the reaction r_n at the end of the step.
class PlaneConstraint {
 public:
  /// @param plane without friction
  /// @param spacing of the nodes [m]: distances below 1e-9 of it count as none
  PlaneConstraint(const Plane& plane, Eigen::Index nodes, double spacing);

  void put(NodalVectors& x) const;      ///< the held nodes onto the plane
  void project(NodalVectors& v) const;  ///< the held nodes' components along the normal to zero
  void stiffen(BlockMatrix& K) const;   ///< along the normal of held nodes, by much: for a preconditioner

  /// Releases and holds nodes after a solution.
  /// @param x0,x1 positions at the step's two ends [m]
  /// @param unbalanced forces at the nodes, which the reactions of held ones balance [N]
  /// @param scale of the forces [N]
  /// @param fixed unknowns: a node with any is not held
  /// @return whether any was
  bool revise(const NodalVectors& x0, const NodalVectors& x1, const NodalVectors& unbalanced, double scale,
              const std::vector<char>& fixed);

  const std::vector<int>& held() const { return held_; }
  const Vec3& normal() const { return plane_.normal; }

 private:
  Plane plane_;
  double spacing_;
  std::vector<char> is_held_;
  std::vector<int> held_;
};

}  // namespace springproof
