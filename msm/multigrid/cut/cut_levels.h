// Lattices of cut cells, in which the smallest cells give way to cells of twice the edge level by level; those are cut
// cells again, of one material, by the moments of their children.
#pragma once

#include <Eigen/SparseCholesky>
#include <vector>

#include "msm/laws/laws.h"
#include "msm/multigrid/cut/cut_matrix.h"

namespace springproof {

/// One level: cells with corners of their own, and how its points follow those of the next coarser level.
struct CutLevel {
  double edge = 0;                        ///< of the smallest cells [m]
  std::vector<LatticeCube> cubes;         ///< of the cells, in edges
  std::vector<Hexahedron> corners;        ///< points
  std::vector<FilledPart> filled;         ///< of the cells
  std::vector<std::uint8_t> materials;    ///< of the cells; empty: one
  std::vector<std::array<int, 3>> point;  ///< in edges
  std::vector<CarriedPoint> carried;      ///< points without rows and columns in A
  std::vector<Anchor> anchors;            ///< on the corners of a cell, free directions of their nodes eliminated
  std::vector<InterfaceBond> bonds;       ///< on the corners of two cells

  // Transfer to the coarser level; empty on the coarsest.
  std::vector<int> parent;                              ///< cell of the coarser level that contains each cell
  Eigen::SparseMatrix<float, Eigen::RowMajor> weights;  ///< of the coarser level's points, a row for each point

  /// Points that move the corners of a cell with anchors, or of two with bonds, which are stiffer than others: they are
  /// relaxed together.
  std::vector<std::vector<int>> anchored_points() const;
  /// Their rows and columns of A, large on the diagonal of fixed unknowns.
  Eigen::MatrixXd dense(const std::vector<int>& points) const;
  std::vector<std::vector<int>> anchored;         ///< anchored_points()
  std::vector<Eigen::MatrixXf> anchored_inverse;  ///< of dense()
  void invert_anchored();                         ///< sets the two
  void relax_anchored(std::size_t number, const float* b, float* x) const;

  CutMatrix<float> A;    ///< in units of the shear modulus times the finest edge
  std::vector<float> D;  ///< inverse diagonal blocks of A

  Eigen::Index unknowns() const { return 3 * static_cast<Eigen::Index>(point.size()); }
  /// Of a cell.
  CellShape shape(std::size_t cell) const {
    return {edge * cubes[cell].size, filled[cell], Vec3::Ones(), material(cell)};
  }
  int material(std::size_t cell) const { return materials.empty() ? 0 : materials[cell]; }
  /// out += P^T r and u += P coarse; `coarse` and its right-hand side `out` are of the next level.
  void restrict_to(const Eigen::VectorXf& r, const CutLevel& next, Eigen::VectorXf& out) const;
  void prolongate(Eigen::VectorXf& coarse, const CutLevel& next, Eigen::VectorXf& u) const;
};

/// Averaged springs in the cells of a level; both must outlive it.
StiffnessOfCells averaged_cells(const AveragedSprings& law, const CutLevel& level);

/// The nodes of a network of cut cells that are anchored, and those that are corners of cells.
struct AnchoredNodes {
  std::vector<Anchor> anchors;
  std::vector<CarriedPoint> carried;
  std::vector<char> fixed;  ///< per unknown of the network; carried ones count as such
  int corners = 0;          ///< nodes that are corners; the anchored ones follow

  AnchoredNodes(const Network& network, std::vector<char> fixed_unknowns);
  /// Whether supports hold the node of an anchor in all directions in which it acts, as in all cases.
  bool holds(const Anchor& anchor) const;
  /// Inverse of an anchor's stiffness in the free directions of its node; zero in others.
  Eigen::Matrix3d inverse_of_free(const Anchor& anchor) const;
  std::vector<char> unknowns_of_corners() const { return {fixed.begin(), fixed.begin() + 3 * corners}; }  ///< fixed?
  /// The same; empty if none but carried ones is.
  std::vector<char> fixed_corners() const;

  /// Right-hand side of the corners once the free directions of anchored nodes are eliminated; zero where fixed.
  Eigen::VectorXd eliminated(const Eigen::VectorXd& r) const;
  /// y = K x of all nodes, x zero in carried unknowns, from the matrix of the cells in `unit` [N/m].
  void multiply(const CutMatrix<double>& of_cells, double unit, const Eigen::VectorXd& x, Eigen::VectorXd& y) const;
  /// The solution from that of the corners.
  void complete(const Eigen::VectorXd& r, const Eigen::VectorXd& of_corners, Eigen::VectorXd& z) const;
};

/// The levels of a network of cut cells, without their matrices, finest first.
/// @param law of the cells, by which coarser levels have springs where supports hold corners; nullptr: those of
///   anchors alone
std::vector<CutLevel> cut_levels(const Network& network, const AnchoredNodes& nodes,
                                 const AveragedSprings* law = nullptr);

/// Sets a level's matrix, with anchors and without the rows and columns of `fixed` (empty: none), from that of its
/// cells alone.
void take_matrix(const CutMatrix<double>& of_cells, double unit, const std::vector<char>& fixed, CutLevel& level);

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

}  // namespace springproof
