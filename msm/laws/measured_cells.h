// Force law: cells whose stiffness was measured in a finer lattice of the same body (msm/coarsening/).
#pragma once

#include <vector>

#include "msm/algebra/block_matrix.h"
#include "msm/laws/averaged_springs.h"
#include "msm/laws/law_traits.h"
#include "msm/topology/network.h"

namespace springproof {

/// How a cell is deformed, y [m]: its edge l times the strain log U (xx, yy, zz, 2 yz, 2 zx, 2 xy), U the stretch of
/// the mean deformation gradient F of the part that the body fills; then F^T q, q the patterns of its corners that F
/// does not see (corner_patterns(), 3 * pattern + axis).
inline constexpr int deformations_of_cell = 18;
using DeformationRows = Eigen::Matrix<double, deformations_of_cell, 24>;
using DeformationForm = Eigen::Matrix<double, deformations_of_cell, deformations_of_cell>;
using Deformations = Eigen::Matrix<double, deformations_of_cell, 1>;

/// Where a cell has which corners.
struct CellAt {
  const CellShape& shape;
  const Hexahedron& corners;
};

/// Which strain y begins with.
enum class StrainOfCell {
  logarithmic,
  green_lagrange,  ///< (F^T F - 1) / 2, quadratic in the positions
};

/// y at positions x [m], n x 3.
Deformations deformations(StrainOfCell strain, const CellAt& cell, const NodalVectors& x);

/// f -= s dy/dx at positions x.
/// @param s stresses, work per y [N]
void add_forces_of(StrainOfCell strain, const Deformations& s, const CellAt& cell, const NodalVectors& x,
                   NodalVectors& f);

/// The same over a step from x0 to x1: forces that do the work s . (y0 - y1), without a torque about the mean positions
/// (EnergyMomentum).
void add_mean_forces_of(StrainOfCell strain, const Deformations& s, const CellAt& cell, const NodalVectors& x0,
                        const NodalVectors& x1, NodalVectors& f);

/// The part of a form that resists changes of shape: P M P, P y without the mean of the first three strains.
DeformationForm without_volume(const DeformationForm& M);

/// y of small displacements of the corners, 3 * corner + axis.
DeformationRows deformation_of(const CellShape& cell);

/// The form M of a cell of averaged springs at rest [N/m]: energy y.M y / 2.
DeformationForm form_of(const AveragedSprings& law, const CellShape& cell);

struct MeasuredCells;
/// Averaged springs of the moduli that measured cells have in the mean over their volume.
AveragedSprings mean_springs(const MeasuredCells& law, const CellSet& cells);

/// Numbers of a symmetric form: its lower triangle row by row.
inline constexpr int numbers_of_form = deformations_of_cell * (deformations_of_cell + 1) / 2;

/// Energy y.M y / 2 of each cell, M a symmetric form of its own: Hencky's law where M is form_of() averaged springs.  A
/// rigid motion has no energy, and none can be negative while the forms are not.
struct MeasuredCells {
  /// What solvers, kernels and the time step use of this law.
  static constexpr LawTraits traits = {"measured cells",
                                       Reach::cells,
                                       {Capability::cell_kernels, Capability::cells_of_any_shape,
                                        Capability::cut_multigrid, Capability::energy_momentum}};
  /// Why it cannot what its traits say; nullptr: it can (law_traits.h).
  const char* lacks(Capability what) const;

  std::vector<double> form;  ///< numbers_of_form of each cell, M [N/m]

  /// Names the parameters, for springs files (law_traits.h).
  template <class Fields>
  void fields(Fields& f) {
    f.of_cells("form_N_m", form, numbers_of_form);
  }

  double energy(const Network& network, const NodalVectors& x) const;  ///< [J]; +inf if a cell is inverted
  void add_forces(const Network& network, const NodalVectors& x, NodalVectors& f) const;  ///< f += -dE/dx [N]
  void add_tangent(const Network& network, const NodalVectors& x, BlockMatrix& K) const;  ///< K += d2E/dx2 [N/m]

  /// f += the forces [N] of dashpots of the same forms: `time` [s] times M y' resists the rate of y, so that the matrix
  /// at rest is `time` times the stiffness.  No rigid motion is resisted, and both momenta are kept.  v: velocities
  /// [m/s], n x 3.
  void add_viscous_forces(const Network& network, const NodalVectors& x, const NodalVectors& v, double time,
                          NodalVectors& f) const;

  /// M of a cell [N/m].
  DeformationForm form_of_cell(std::size_t cell) const;
  /// The next cell's.
  void add_form(const DeformationForm& M);
  /// Stiffness of a cell [N/m]; unknown 3 * corner + axis.
  Eigen::Matrix<double, 24, 24> cell_matrix(const CellSet& cells, std::size_t cell) const;
};

}  // namespace springproof
