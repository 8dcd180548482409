// Local strain, stress and momentum flow in a network; Young's modulus and Poisson's ratio of a stretched block, as the
// papers measure them.
#pragma once

#include <vector>

#include "msm/laws/laws.h"

namespace springproof {

/// Tension of each spring [N], positive if it pulls: its own plus that added by momentum dispersion.  Forces of cells
/// and angles are not tensions, so the measured stress of models with those is incomplete.
/// @param u displacements from rest [m]
std::vector<double> linear_tensions(const MassSpringModel& model, const NodalVectors& u);

/// Displacement gradient du_i/dX_j at a point: linear fit to the nodes closer than `radius` [m], weights (1 -
/// r^2/R^2)^2 (moving least squares; an affine field is exact).  In a planar network (all z equal) d/dz is 0.
/// @throws std::invalid_argument if the nodes within reach do not span the space (plane).
Eigen::Matrix3d displacement_gradient(const Network& network, const NodalVectors& u, const Vec3& point, double radius);

/// Mean stress in a ball [Pa]: (1/V) sum_s T_s n (x) d_s over the parts d_s of the springs inside, n their direction;
/// the bond form of Hardy (1982).  Symmetric.  x: node positions, Network::X for a linear model.
/// The ball must lie inside the body: any part outside counts as material without stress.
Eigen::Matrix3d hardy_stress(const Network& network, const NodalVectors& x, const std::vector<double>& tensions,
                             const Vec3& point, double radius);

/// Force with which the side of a plane towards `normal` (unit) pulls the other side [N], positive in tension: sum over
/// the springs that cross the plane of the normal component of their tension; Kot et al. (2014), sec. 5.1.  Nodes on
/// the plane are on the side of `normal`.
double momentum_flow(const Network& network, const NodalVectors& x, const std::vector<double>& tensions,
                     const Vec3& point, const Vec3& normal);

/// Poisson's ratio from normal strains and stresses along the axes, also if the sides are not free of stress:
/// (exx syy - eyy sxx) / (exx (sxx + szz) - eyy (syy + szz)).  Kot & Nagahashi (2015), eq. (29), DEVIATION: subscripts
/// of the denominator, docs/papers.md #15.
double poisson_ratio_of(const Eigen::Matrix3d& strain, const Eigen::Matrix3d& stress);

/// Eq. (29) as printed: nu/(1 + nu) in uniaxial stress.  For the record only.
double poisson_ratio_as_printed(const Eigen::Matrix3d& strain, const Eigen::Matrix3d& stress);

/// A block [lower, upper] stretched along x.
struct StretchedBlock {
  Vec3 lower;         ///< lowest corner [m]
  Vec3 upper;         ///< highest corner [m]
  double elongation;  ///< relative displacement of its ends [m]
};

/// What is measured of it.
struct BlockModuli {
  double force;                    ///< momentum flow through the middle plane [N]
  double youngs_modulus_nominal;   ///< (F/A) / (elongation / L_x) [Pa]; Kot et al. (2014), sec. 5.1.  Too high if grips
                                   ///< shorten the length
  double youngs_modulus_local;     ///< (F/A) / (mean strain of the central region) [Pa]
  double poisson_ratio;            ///< by regression of the displacements in the central region [1]
  double poisson_ratio_of_fields;  ///< mean of eq. (29), corrected, over points of the central region
  double poisson_ratio_as_printed;  ///< the same by (29) as printed
};

/// Linear measures in the middle 80 % of the block along every axis.  `radius` [m]: of the local strain and stress, at
/// 7 x 3 x 3 points of that region whose balls lie inside the block.
/// @throws std::invalid_argument if the central region or a ball holds too few nodes for a gradient.
BlockModuli measure_block(const MassSpringModel& model, const NodalVectors& u, const StretchedBlock& block,
                          double radius);

}  // namespace springproof
