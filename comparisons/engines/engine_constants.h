// What the soft bodies of real-time engines take for a material: docs/engines.md.
#pragma once

#include <array>
#include <vector>

#include "comparisons/results/facts.h"
#include "meshes/mesh.h"
#include "problem/material.h"

namespace springproof {

/// mu and lambda of the neo-Hooke material of Bullet's deformable bodies.  Its energy (Smith, de Goes & Kim 2018, eq.
/// 14) gives at rest G = 3/4 mu and, as Lame's first parameter, lambda - 5/8 mu.
struct BulletNeoHooke {
  double mu, lambda;  ///< [Pa]
};

/// The constants with which Bullet's neo-Hooke material has the moduli of `material` at rest: mu = 4/3 G, lambda =
/// Lame's + 5/6 G.
BulletNeoHooke bullet_neo_hooke(const IsotropicMaterial& material);

/// Compliance [m^5/N] of a position-based constraint on six times the volume of a tetrahedron, C = 6 V' - 6 V with
/// energy C^2 / (2 compliance), that adds the bulk modulus `bulk` [Pa]: 36 V / bulk.
double volume_compliance(double tetrahedron_volume, double bulk);

/// Share of critical damping that implicit Euler adds to a vibration of this frequency [Hz] at this step [s], both
/// small: pi f dt.
double implicit_euler_damping(double frequency, double time_step);

/// Smallest step [s] at which single precision still moves a node `reach` [m] from the origin by its acceleration
/// [m/s^2]: acceleration * step^2 is then the spacing 2^-23 reach of the numbers there.
double least_single_precision_step(double reach, double acceleration);

/// Largest step [s] of position-based dynamics with one sweep over the springs per step at which a lattice is at most
/// 2 % too soft: a quarter of the safe step of explicit integration (measured, docs/engines.md).
double largest_sweep_step(double safe_time_step);

/// Safe step [s] of undamped explicit integration of cubes of this edge [m] cut into five linear tetrahedra each, with
/// an eighth of a cube's mass at each of its corners: 2 / omega of the stiffest single cube, which bounds all meshes
/// (Irons and Treharne).
double safe_time_step_of_tetrahedra(const IsotropicMaterial& material, double edge);

/// Five tetrahedra of each cube, of positive volume: one between every second corner, of a third of the volume, and one
/// at each of the other four corners.  Neighbours are mirror images of each other, so that their faces are cut along
/// the same diagonals and no direction is preferred.
/// @param X    nodes [m], n x 3
/// @param edge of the cubes [m], which are cells of one lattice along the axes
std::vector<Tetrahedron> five_tetrahedra(const NodalVectors& X, const std::vector<Hexahedron>& cells, double edge);

struct EngineFacts {
  const IsotropicMaterial& material;
  double edge;                  ///< of the cells [m]
  std::array<double, 3> inner;  ///< stiffness of springs inside the lattice [N/m]: cell edges, face diagonals, cube
                                ///< diagonals; 0: none
  double correction;            ///< bulk modulus that the model adds to its springs' [Pa]
  double frequency;             ///< of a vibration [Hz]
};

/// Compliances of springs inside, on the surface and on the edges of a lattice, of the constraint on 6 V of a corner
/// tetrahedron (a sixth of a cell) that adds the correction, Bullet's constants, the damping by implicit Euler and the
/// smallest step of single precision 1 m from the origin under 9.81 m/s^2.
FactGroup facts_of(const EngineFacts& facts);

}  // namespace springproof
