#include "msm/coarsening/layered_solver.h"

#include <Eigen/Cholesky>
#include <algorithm>

#include "msm/kernels/kernels.h"

namespace springproof {
namespace {

using Part = Eigen::Ref<Eigen::MatrixXd>;
using ConstPart = const Eigen::Ref<const Eigen::MatrixXd>&;

constexpr Eigen::Index group_width = 12;  // columns that are eliminated together

DenseProduct<double> product(ConstPart a, ConstPart b, Part c) {
  return {c.rows(), c.cols(), a.cols(),        a.data(), a.outerStride(),
          b.data(), 1,        b.outerStride(), c.data(), c.outerStride()};
}

/// c -= a b.
void subtract(ConstPart a, ConstPart b, Part c) { kernels_of<double>().dense.subtract(product(a, b, c)); }

/// c -= a b^T.
void subtract_transposed(ConstPart a, ConstPart b, Part c) {
  DenseProduct<double> p = product(a, b, c);
  std::swap(p.b_row, p.b_column);
  kernels_of<double>().dense.subtract(p);
}

/// Calls act(first, number) for columns that are eliminated together.
template <class Act>
void each_group(Eigen::Index columns, const Act& act) {
  for (Eigen::Index j = 0; j < columns; j += group_width) act(j, std::min(group_width, columns - j));
}

/// Factors of the upper rows, which are square; the others follow.
bool factor_columns(Eigen::MatrixXd& L) {
  bool definite = true;
  each_group(L.cols(), [&](Eigen::Index j, Eigen::Index n) {
    if (!definite) return;
    const Eigen::Index rows = L.rows() - j;
    subtract_transposed(L.block(j, 0, rows, j), L.block(j, 0, n, j), L.block(j, j, rows, n));
    Part corner = L.block(j, j, n, n);
    definite = Eigen::LLT<Part>(corner).info() == Eigen::Success;  // in place
    Part lower = L.block(j + n, j, rows - n, n);
    if (definite) corner.triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(lower);
  });
  return definite;
}

}  // namespace

LayeredMatrix::LayeredMatrix(const std::vector<int>& unknowns) : begin_{0} {
  for (std::size_t l = 0; l < unknowns.size(); ++l) {
    begin_.push_back(begin_.back() + unknowns[l]);
    const int next = l + 1 < unknowns.size() ? unknowns[l + 1] : 0;
    columns_.push_back(Eigen::MatrixXd::Zero(unknowns[l] + next, unknowns[l]));
  }
}

bool LayeredMatrix::factor() {
  for (std::size_t l = 0; l < columns_.size(); ++l) {
    if (!factor_columns(columns_[l])) return false;
    const Eigen::Index rows = below_of(l);
    each_group(rows, [&](Eigen::Index j, Eigen::Index n) {
      const auto L = columns_[l].bottomRows(rows - j);
      subtract_transposed(L, L.topRows(n), columns_[l + 1].block(j, j, rows - j, n));
    });
  }
  return true;
}

void LayeredMatrix::solve(Eigen::MatrixXd& b) const {
  Eigen::MatrixXd x = b.transpose();  // x L^T = b, then x L = b
  const auto of_layer = [&](std::size_t l) { return x.middleCols(begin_[l], begin_[l + 1] - begin_[l]); };
  for (std::size_t l = 0; l < columns_.size(); ++l) {
    const Eigen::MatrixXd& L = columns_[l];
    Part own = of_layer(l);
    each_group(L.cols(), [&](Eigen::Index j, Eigen::Index n) {
      Part here = own.middleCols(j, n);
      subtract_transposed(own.leftCols(j), L.block(j, 0, n, j), here);
      L.block(j, j, n, n).triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(here);
    });
    if (below_of(l) > 0) subtract_transposed(own, L.bottomRows(below_of(l)), of_layer(l + 1));
  }
  for (std::size_t l = columns_.size(); l-- > 0;) {
    const Eigen::MatrixXd& L = columns_[l];
    Part own = of_layer(l);
    if (below_of(l) > 0) subtract(of_layer(l + 1), L.bottomRows(below_of(l)), own);
    for (Eigen::Index end = L.cols(), j = (end - 1) / group_width * group_width; j >= 0; end = j, j -= group_width) {
      const Eigen::Index n = end - j, after = L.cols() - end;
      Part here = own.middleCols(j, n);
      subtract(own.rightCols(after), L.block(end, j, after, n), here);
      L.block(j, j, n, n).triangularView<Eigen::Lower>().solveInPlace<Eigen::OnTheRight>(here);
    }
  }
  b = x.transpose();
}

}  // namespace springproof
