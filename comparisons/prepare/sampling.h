// The points at which displacements are requested: the nodes of the lattices, then the measured points.
#pragma once

#include "comparisons/prepare/prepared_case.h"

namespace springproof {

/// Rest positions of the probes, n x 3 [m].
NodalVectors probe_points(const Experiment& experiment);

/// The probes, then the points of the patches whose mean displacement is measured.
NodalVectors measured_points(const PreparedCase& prepared);

/// Rest positions of the nodes of every lattice, one after the other.
NodalVectors lattice_points(const PreparedCase& prepared);

/// One after the other.
NodalVectors stacked(const NodalVectors& a, const NodalVectors& b);

/// The part of Solution::displacement that belongs to the nodes of one lattice.
NodalVectors at_nodes(const Lattice& lattice, const NodalVectors& samples);

/// Displacement at the nodes of every lattice, one after the other, from that at Samples::points.
NodalVectors at_lattice_nodes(const PreparedCase& prepared, const NodalVectors& at_points);

/// Displacement at the measured points from that of a lattice's nodes.  A point of a patch, and in a body of voxels a
/// probe, may lie outside the cells: the nearest one is extrapolated.
/// @throws InputError naming a probe outside the body.
NodalVectors at_measured_points(const PreparedCase& prepared, const Lattice& lattice, const NodalVectors& displacement);

/// Rest positions at which stresses are requested: the probes, if the case measures them there, the middles of cells
/// all over the body, if it compares them, then the surface that is pictured.
NodalVectors stress_points(const PreparedCase& prepared);

/// Where the finite elements are asked for them: there, then of a block whose stresses are compared in the middles of
/// all lattices' cells, so that those of linear elements can be averaged at nodes.
NodalVectors requested_stress_points(const PreparedCase& prepared);

/// How many of stress_points() are probes.
Eigen::Index stress_probes(const PreparedCase& prepared);

/// The volume that each of them stands for [m^3]: 0 of probes and of the surface.
Eigen::VectorXd stress_volumes(const PreparedCase& prepared);

}  // namespace springproof
