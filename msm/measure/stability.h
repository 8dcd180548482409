// Whether a model's vibrations at rest stay bounded: the eigenvalues of a small free block.
#pragma once

#include "msm/parameters/model_table.h"

namespace springproof {

struct BlockStability {
  double asymmetry;  ///< |K - K^T| / |K| (Frobenius); 0 if there is an energy
  double
      smallest_eigenvalue;  ///< real part of those of M^-1 K, rigid motions aside, over the largest; negative: unstable
  double flutter_damping;   ///< mass-proportional damping [1/s] below which a motion grows: max |Im| / sqrt(Re); 0 if
                            ///< all are real
};

/// All eigenvalues of a free block of 3 x 3 x 3 cells (planar networks: 6 x 6) of edge `cell_edge` [m].
BlockStability block_stability(const ModelParameters& parameters, const IsotropicMaterial& material, double cell_edge);

/// Where the model with this material is stable, and how that is known: one line, of the weights and the q it really
/// has.
std::string stable_range(const ModelParameters& parameters, const IsotropicMaterial& material);

}  // namespace springproof
