// Where a model holds: its stress and equilibrium under large uniaxial strain, and its stability at rest, from the
// eigenvalues of a small free block.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "msm/parameters/model_table.h"

namespace springproof {

/// Axial strain of uniaxial tension (free sides) at which a homogeneous cell loses equilibrium or stability;
/// +infinity if it does not up to 50 %.
struct StrainLimits {
  double bounded_energy;  ///< with VolumeEnergy::bounded [1]
  double paper_energy;    ///< with VolumeEnergy::paper [1]
};

/// Those of one cell of a model.
StrainLimits strain_limits(const ModelParameters& parameters, const IsotropicMaterial& material);

/// Stress [Pa], force over the area at rest, of a bar with free sides at one stretch (length over that at rest).
struct StressAtStretch {
  double stretch;                   ///< [1]
  std::optional<double> model;      ///< of one cell; empty: no stable equilibrium
  double hencky;                    ///< of Hencky's law
  std::optional<double> neo_hooke;  ///< of the neo-Hookean law; empty: it has no state there
};

/// Stretches of 0.6 to 1.4.
std::vector<StressAtStretch> stress_curve(const ModelParameters& parameters, const IsotropicMaterial& material);

/// The sides of a body that is stretched along z.
enum class Sides { free, held };

/// Where a homogeneously stretched lattice without end is no longer stable.
struct StrainLimit {
  double strain;  ///< the last stable one along z, negative in compression [1]
  /// Of the wave that grows beyond it, in units of pi / l: 1 along an axis along which neighbours move against each
  /// other; 0: all of the lattice gives way sideways.
  Vec3 k;
};

/// The first strain on the way to `strain` that a wave (weakest_wave()) or the homogeneous state itself does not
/// survive, to 1e-4.  A body of these cells is stable beyond it only where its size or supports forbid the wave.
/// @param parameters of a lattice of cells without momentum dispersion
/// @param material of it
/// @param sides free: no stress across z; held: no strain across z
/// @param strain along z, more than -1
/// @return the limit; empty: all are stable
/// @throws std::invalid_argument for other models.
std::optional<StrainLimit> strain_limit(const ModelParameters& parameters, const IsotropicMaterial& material,
                                        Sides sides, double strain);

/// "neighbours move against each other along x and y": what a wave of the short ones does; else "waves of all lengths".
std::string describe_wave(const Vec3& k);

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
