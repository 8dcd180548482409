// Stability of a model at rest, from the eigenvalues of a small free block.
#pragma once

#include "msm/parameters/model_table.h"

namespace springproof {

/// Whether a free block is stable, and how fast it flutters if not.
struct BlockStability {
  double asymmetry;            ///< |K - K^T| / |K| (Frobenius); 0 if conservative
  double smallest_eigenvalue;  ///< real part of those of M^-1 K without rigid motions, over the largest; negative:
                               ///< unstable
  double flutter_damping;  ///< mass-proportional damping [1/s] below which a motion grows: max |Im| / sqrt(Re); 0 if
                           ///< all are real
};

/// All eigenvalues of a free block of 3 x 3 x 3 cells (springs fitted to the patch test: 6 x 6 x 6, planar networks:
/// 6 x 6) of edge `cell_edge` [m].
BlockStability block_stability(const ModelParameters& parameters, const IsotropicMaterial& material, double cell_edge);

/// One line on where the model with this material is stable, and how that is known, for its actual weights and q.
std::string stable_range(const ModelParameters& parameters, const IsotropicMaterial& material);

}  // namespace springproof
