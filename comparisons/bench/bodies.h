// Benchmark bodies: lattices of cubes of 0.1 m and disordered networks of that spacing, with their supports and loads.
#pragma once

#include <array>
#include <string>

#include "msm/embedding/boundary.h"
#include "msm/laws/laws.h"
#include "problem/case_file/experiment.h"

namespace springproof::bench {

inline constexpr double edge = 0.1, youngs_modulus = 1e4, density = 1000;  // [m], [Pa], [kg/m^3]

/// A block of `cells` cubes as a model of the table (msm/models.h) at a Poisson's ratio, with options as in case files.
MassSpringModel lattice(const std::string& name, const std::array<int, 3>& cells, double poisson_ratio,
                        const decltype(ModelChoice::options)& options = {});

/// A cubic random network of about `nodes` nodes, <S> = 15, nu = 1/4.
MassSpringModel random_springs(int nodes);

/// A ball of about `cells` cells of averaged springs, cut along its surface, at a Poisson's ratio.
/// @throws as mesh_body()
MassSpringModel cut_ball(double cells, double poisson_ratio);

/// The rest positions, each moved by a hundredth of an edge at most: smooth and reproducible.
NodalVectors moved(const Network& network);

/// As springproof::clamped_bottom() (comparisons/advise/speed.h), of this density.
BoundaryConditions clamped_bottom(const Network& network, double depth = 1e-6 * edge);

}  // namespace springproof::bench
