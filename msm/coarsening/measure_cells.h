// Measures the cells of a body in a finer lattice of it (numerical coarsening).
#pragma once

#include <Eigen/SparseCore>
#include <functional>
#include <string>
#include <vector>

#include "msm/coarsening/fine_cells.h"
#include "msm/laws/laws.h"
#include "msm/laws/measured_cells.h"

namespace springproof {

/// What cells are measured in.
struct MeasuredIn {
  const CutBody& coarse;  ///< the cells, of one size; of a body of several materials as if it were of one
  const FineCells& fine;  ///< of the same body
  AveragedSprings law;    ///< of its materials, per unit of Young's modulus of the first; nu <= 0.3: near 1/2 noise
                          ///< times the bulk modulus is fitted
  std::vector<std::string> held = {};  ///< names of the patches that supports hold along all axes
};

/// How cells are measured.
struct MeasureOptions {
  int threads = 1;                         ///< that share the cells
  std::function<bool()> interrupted = {};  ///< asked before each cell by each thread; true: stop
};

/// The cells of a body as measured.
struct MeasuredBody {
  MeasuredCells cells;           ///< of the law that they were measured with
  int as_averaged = 0;           ///< cells that keep the form of averaged springs
  double error = 0;              ///< under loads that were not used: rms displacement off the fine lattice, relative
  double error_of_averaged = 0;  ///< the same of averaged springs in all cells, of several materials by their mean
};

/// What is said of measured cells: how far they are off.
/// @param measured cells
/// @return a sentence
/// @throws std::invalid_argument where averaged springs are as good
std::string describe(const MeasuredBody& measured);

/// Measures the cells of a body under loads all over it, each by a problem of the cells around it: cells near a support
/// on the held body, the others on the free one.  Cells that two settings of the fit leave more than a factor of two
/// apart, and those without enough fine cells, keep averaged springs.  In the fine lattice several materials are bonded
/// at their interfaces; a coarse cell has one form, whatever it holds of them.
/// @param in the lattices and their law
/// @param options threads
/// @return a form per cell, and how far they are off
/// @throws std::runtime_error "interrupted", or if a state is not found
MeasuredBody measure_cells(const MeasuredIn& in, const MeasureOptions& options = {});

/// The fine lattice, on its supports, under loads of unit work that cells are not measured by.
class FineTruth {
 public:
  /// @param in the lattices and their law, which must outlive it
  explicit FineTruth(const MeasuredIn& in);
  /// How far cells are off it.
  /// @param of_cells law of the coarse cells
  /// @return relative rms displacement
  double error(const ForceLaw& of_cells) const;

 private:
  const MeasuredIn& in_;
  Eigen::SparseMatrix<double, Eigen::RowMajor> P_;
  Eigen::VectorXd volume_;
  Eigen::MatrixXd load_, truth_;  ///< of the fine nodes, a load per column
};

/// Measured cells in other materials: shear moduli in proportion, the bulk modulus on the mean strain as it is there;
/// in a cell of several materials its harmonic mean.
/// @param measured forms of `of`
/// @param cells of the lattice
/// @param of what they were measured with
/// @param at averaged springs of the other materials, whose bulk over their shear moduli are not smaller
/// @param fine cells of a body of several materials, else nullptr
/// @return forms of `at`
MeasuredCells in_material(const MeasuredCells& measured, const CellSet& cells, const AveragedSprings& of,
                          const AveragedSprings& at, const FineCells* fine = nullptr);

/// What holds the form near to that of averaged springs where the states say little.
struct FitSettings {
  double ridge = 0.1;       ///< weight of the metric, in units of the mean square of a deformation of the states
  double least = 0.02;      ///< eigenvalues of the form in the metric ...
  double largest = 3;       ///< ... are clipped to these
  bool of_scalars = false;  ///< in the metric strains and patterns are scaled to the states' forces, each by a number
};

/// Least squares: minimises sum |L^T C L y - s|^2 in the metric L L^T of `averaged` over symmetric C, with a ridge
/// about C = 1, and clips the eigenvalues of C.
/// @param averaged form of the cell, positive definite [N/m]
/// @param y deformations of the states, one per column [m]
/// @param s stresses of the states [N]
/// @param settings of the fit
/// @return L C L^T [N/m]
DeformationForm fit_form(const DeformationForm& averaged, const Eigen::MatrixXd& y, const Eigen::MatrixXd& s,
                         const FitSettings& settings = {});

}  // namespace springproof
