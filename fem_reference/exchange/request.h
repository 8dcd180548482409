// What the finite element reference is asked, and what it answers.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "meshes/field.h"
#include "problem/attached_mass.h"
#include "problem/course.h"
#include "problem/loads.h"
#include "problem/material.h"
#include "problem/patch_rule.h"
#include "problem/region.h"
#include "problem/relaxation.h"
#include "problem/system/run_cost.h"

namespace springproof::fem {

/// One discretisation of the body.
struct Discretisation {
  Cells cells;                 ///< nx, ny, nz of the .geo: cells along each side of a block
  std::string element = "q2";  ///< "q1", "q2" (hexahedra), "p1", "p2" (tetrahedra)
  double grading = 1.0;    ///< exponent that grades the cells of a block towards its faces (fem::graded); 1 = uniform
  int mesh = -1;           ///< index into Request::meshes, used instead of the .geo; -1: none
  int refinements = 0;     ///< of that mesh's hexahedra: each is cut into 8 this many times
  double times_cells = 1;  ///< of tetrahedra of second order: cut where their estimated error is largest, until there
                           ///< are so many times as many (local_refinement.h)
  int steps = 0;           ///< in which Request::motion is made on this grid
  std::string vtu = {};    ///< file for ParaView: the solution and its stress on the elements' own mesh; empty: none
};

/// xx yy zz xy yz xz [Pa], one row per point.
using Stresses = Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>;

/// Motion in time under the loads.
struct MotionRequest {
  double duration = 0;    ///< [s]
  double damping = 0;     ///< mass-proportional, force -damping rho v per volume [1/s]
  Course course = {};     ///< of the loads and moved supports
  bool released = false;  ///< it starts from equilibrium under the loads, which are removed instead; supports stay
  Vec3 velocity = Vec3::Zero();  ///< at the start, of the body as a whole [m/s]
  Vec3 spin = Vec3::Zero();      ///< and about its centre of mass [rad/s]
  double viscosity = 0;          ///< time of retardation of a Kelvin-Voigt solid: to the stress of a strain E it adds
                                 ///< `viscosity` times Hooke's stress of dE/dt [s]
  Relaxation relaxation = {};    ///< in shear, beside the material's long-time moduli
  bool energy_momentum = false;  ///< steps do the work of the law's stress exactly; false: the midpoint rule
};

/// What is the same on every grid.
struct CommonProblem {
  std::string law = "linear";  ///< or a law of finite strain (fem_reference/elements/laws.h)
  IsotropicMaterial material;
  std::vector<Load> loads;
  NodalVectors points;  ///< rest positions at which the displacement is requested, n x 3 [m]; for a given mesh also
                        ///< outside, where it is extrapolated from the nearest cell
  NodalVectors stress_points = NodalVectors(0, 3);  ///< rest positions at which the stress is requested, m x 3 [m]
  double tolerance = 1e-9;                          ///< relative residual of the linear solves
  int modes = 0;  ///< compute so many natural modes instead of a displacement: supports at rest, no other loads
  std::optional<MotionRequest> motion = {};  ///< integrate in time instead of an equilibrium
  std::vector<AttachedMass> masses =
      {};  ///< that modes and motions have beside the body's own; their weight is in `loads`
};

struct Request : CommonProblem {
  std::string name;                          ///< of the case, in messages
  std::filesystem::path geo;                 ///< gmsh script of the body, for grids without a given mesh
  Vec3 size = Vec3::Zero();                  ///< its parameters [m]
  std::vector<PatchRule> patches = {};       ///< added to it by mesh_grids(), which the program is not told of
  std::vector<MaterialRegion> regions = {};  ///< of Mesh::materials from 1 on; the program is told of their materials
  std::vector<Discretisation> grids;
  std::vector<std::shared_ptr<const Mesh>> meshes = {};  ///< bodies as given, instead of the .geo
  bool cost = false;                                     ///< measure times and memory for comparison (RunTimes)
  bool vtu_single = false;                               ///< Discretisation::vtu in single precision
};

/// Means over a region, and its energy.
struct RegionMeans {
  double volume_change = 0;                ///< of det F - 1 [1]
  Vec3 displacement = Vec3::Zero();        ///< over the volume at rest [m]
  Stresses stress = Stresses::Zero(1, 6);  ///< Cauchy's, at large strain over the deformed volume [Pa]
  double energy = 0;                       ///< in all [J]; of laws without one NaN
};

/// Between the cells of two materials, numbers in Mesh::materials.
struct InterfaceForce {
  int material = 0, other = 0;  ///< material > other
  Vec3 force = Vec3::Zero();    ///< on the first by the second [N]
};

/// The result on one grid.
struct Solution {
  Discretisation grid;
  bool ok = false;
  std::string message;        ///< reason of failure, with the load reached
  std::string form;           ///< "Q2 displacement, CG, matrix-free multigrid", "P2-P1 mixed, GMRES, ...", ...
  std::string law;            ///< "linear", "hencky", ...
  NodalVectors displacement;  ///< at Request::points [m]
  Stresses stress;            ///< Cauchy stress at Request::stress_points
  std::vector<PatchReaction> reactions;
  std::vector<RegionMeans> regions = {};        ///< of Request::regions
  std::vector<InterfaceForce> interfaces = {};  ///< of all that meet
  double volume_change = 0;                     ///< exact, by the element's own quadrature [1]
  double volume_change_first_order = 0;         ///< integral of div u / V [1]
  double min_jacobian = 1;                      ///< min det F at quadrature points
  long degrees_of_freedom = 0;                  ///< of the displacement, including constrained ones
  long unknowns = 0;                            ///< unconstrained degrees of freedom
  long cells = 0;                               ///< of the finest mesh
  long cells_per_process = 0;                   ///< of them in the memory of the largest process, with ghost cells
  int iterations = 0;                           ///< of the linear solver, all steps together
  double residual = 0;                          ///< relative, of the final state
  double seconds = 0;                           ///< CPU time of this grid, of all processes
  RunTimes times;                      ///< the part of it spent on the displacement; the rest is post-processing
  std::vector<double> frequencies;     ///< of Request::modes and some more, ascending, without rigid motions [Hz]
  std::vector<NodalVectors> shapes;    ///< of these modes, at Request::points [kg^-1/2]
  int rigid_motions = 0;               ///< that the supports leave
  std::vector<double> time;            ///< of Request::motion: 0 and the end of every step [s]
  std::vector<NodalVectors> path;      ///< displacements at Request::points at these times [m]
  std::vector<double> kinetic_energy;  ///< at these times [J]
  std::vector<double> elastic_energy;  ///< [J]; of laws at finite strain that have one, else empty
  std::vector<Vec3> angular_momentum;  ///< about the origin [kg m^2/s]
  double memory_MiB = 0;  ///< peak resident set so far, of the largest process; for an experiment with `cost` the
                          ///< growth due to this grid
};

}  // namespace springproof::fem
