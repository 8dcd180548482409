// Natural frequencies and modes of a model about its rest state.
#pragma once

#include <Eigen/SparseCore>
#include <string>
#include <vector>

#include "msm/laws/laws.h"

namespace springproof {

/// Mass between nodes [kg], n x n, the same for each axis: M = theta C + (1 - theta) L.  C: the consistent mass of the
/// trilinear displacement in each cell, over the part that the body fills: of its mass, its first moments and its
/// second along the axes.  L: the sums of the rows of C; of whole cells an eighth of the cell's mass per corner.
/// What belongs to carried nodes is handed to those that carry them.  Networks without cells have the lumped mass
/// alone, masses().  What is attached is lumped.
/// @param network of a model
/// @param density [kg/m^3]
/// @param theta share of consistent mass, 0 to 1
/// @return M [kg]
/// @throws std::invalid_argument unless 0 <= theta <= 1.
Eigen::SparseMatrix<double> mass_matrix(const Network& network, double density, double theta);

/// Frequencies and shapes.
struct NaturalModes {
  bool ok = false;                   ///< whether there is a result
  std::string message;               ///< why there is no result
  std::vector<double> frequencies;   ///< ascending, without the rigid motions [Hz]
  std::vector<NodalVectors> shapes;  ///< displacement of the nodes, M-orthonormal [kg^-1/2]
  int rigid_motions = 0;             ///< number of motions that the supports leave
  std::string solver;                ///< description of the solver
  int iterations = 0;                ///< of it
  double residual = 0;               ///< largest |K x - omega^2 M x| / |omega^2 M x|
  double seconds = 0;                ///< CPU time of the thread
};

/// The first `count` natural modes (fewer if the model has fewer) of small vibrations about rest, the unknowns
/// 3 * node + axis that are `fixed` at zero.
/// @param model any model whose forces have a potential
/// @param fixed per unknown; all 0: a free body, whose rigid motions are left out
/// @param density [kg/m^3]
/// @param theta share of consistent mass, 0 to 1: mass_matrix()
/// @param count number of modes
/// @return frequencies and shapes; check `ok`
NaturalModes natural_modes(const MassSpringModel& model, const std::vector<char>& fixed, double density, double theta,
                           int count);

}  // namespace springproof
