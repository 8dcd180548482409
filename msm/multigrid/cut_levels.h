// Lattices of cut cells and of cells of twice the edge, which are cut cells again by the moments of their children.
#pragma once

#include <Eigen/SparseCholesky>
#include <vector>

#include "msm/laws/laws.h"

namespace springproof {

/// A sparse matrix of 3x3 blocks in single precision with symmetric pattern.
struct FloatBlocks {
  std::vector<int> begin, column;
  std::vector<float> block;             ///< nine per entry, row by row
  std::vector<float> inverse_diagonal;  ///< nine per row; zero on fixed unknowns

  int rows() const { return static_cast<int>(begin.size()) - 1; }
  /// r = b - A x in row i, three values.
  void residual(const float* b, const float* x, int i, float* r) const;
  /// Gauss-Seidel step of row i.
  void relax(const float* b, int i, float* x) const;
};

/// One level: cells with corners of their own, and how its points follow those of the next coarser level.
struct CutLevel {
  double edge = 0;  ///< [m]
  std::vector<std::array<int, 3>> index;
  std::vector<Hexahedron> corners;
  std::vector<FilledPart> filled;
  std::vector<std::array<int, 3>> point;  ///< in edges
  std::vector<Anchor> anchors;            ///< on the corners of a cell; `node`: bits of the directions that are held

  // Transfer to the coarser level; empty on the coarsest.
  std::vector<int> parent;                      ///< cell of the coarser level that contains each cell
  std::vector<int> weight_begin, weight_point;  ///< per point, of the coarser level's points
  std::vector<float> weight;

  /// Cells with anchors, which are stiffer than cells: their corners are relaxed together.
  std::vector<Hexahedron> anchored;
  std::vector<float> anchored_inverse;  ///< 24 x 24 each, of the corners' rows and columns of A
  void invert_anchored();               ///< sets the two from A
  void relax_anchored(std::size_t number, const float* b, float* x) const;

  FloatBlocks A;  ///< in units of the shear modulus times the finest edge

  Eigen::Index unknowns() const { return 3 * static_cast<Eigen::Index>(point.size()); }
  /// out += P^T r and u += P coarse.
  void restrict_to(const float* r, float* out) const;
  void prolongate(const float* coarse, float* u) const;
};

/// The nodes of a network of cut cells that are anchored, and those that are corners of cells.
struct AnchoredNodes {
  std::vector<Anchor> anchors;
  std::vector<char> fixed;  ///< per unknown of the network
  int corners = 0;          ///< nodes that are corners; the anchored ones follow

  AnchoredNodes(const Network& network, std::vector<char> fixed_unknowns);

  /// Right-hand side of the corners once the free directions of anchored nodes are eliminated; zero where fixed.
  Eigen::VectorXd eliminated(const Eigen::VectorXd& r) const;
  /// The solution from that of the corners.
  void complete(const Eigen::VectorXd& r, const Eigen::VectorXd& of_corners, Eigen::VectorXd& z) const;
};

/// The levels of a network of cut cells, without their matrices, finest first.
std::vector<CutLevel> cut_levels(const Network& network, const AnchoredNodes& nodes);

/// Sets a level's matrix: averaged springs and anchors, without the rows and columns of `fixed` (empty: none).
/// `unit` of stiffness [N/m].
void assemble(const AveragedSprings& law, double unit, const std::vector<char>& fixed, CutLevel& level);

/// Factors a symmetric matrix; if it is singular, as that of a level which has lost its supports, with a multiple of
/// the identity added.
/// @throws std::runtime_error if it is not positive definite.
class CoarsestFactors {
 public:
  void factor(const Eigen::SparseMatrix<double>& K);
  Eigen::VectorXf solve(const Eigen::VectorXf& b) const;

 private:
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> ldlt_;
};

/// The matrix in double precision.
Eigen::SparseMatrix<double> sparse(const FloatBlocks& A);

}  // namespace springproof
