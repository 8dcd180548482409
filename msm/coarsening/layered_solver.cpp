#include "msm/coarsening/layered_solver.h"

#include <Eigen/Cholesky>

namespace springproof {

LayeredMatrix::LayeredMatrix(const std::vector<int>& unknowns) : begin_{0} {
  for (std::size_t l = 0; l < unknowns.size(); ++l) {
    begin_.push_back(begin_.back() + unknowns[l]);
    own_.push_back(Eigen::MatrixXd::Zero(unknowns[l], unknowns[l]));
    if (l + 1 < unknowns.size()) next_.push_back(Eigen::MatrixXd::Zero(unknowns[l + 1], unknowns[l]));
  }
}

bool LayeredMatrix::factor() {
  for (std::size_t l = 0; l < own_.size(); ++l) {
    if (l > 0) own_[l].selfadjointView<Eigen::Lower>().rankUpdate(next_[l - 1], -1);
    Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> llt(own_[l]);  // in place
    if (llt.info() != Eigen::Success) return false;
    if (l < next_.size()) own_[l].triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(next_[l]);
  }
  return true;
}

void LayeredMatrix::solve(Eigen::MatrixXd& b) const {
  const auto rows = [&](std::size_t l) { return b.middleRows(begin_[l], begin_[l + 1] - begin_[l]); };
  for (std::size_t l = 0; l < own_.size(); ++l) {
    if (l > 0) rows(l).noalias() -= next_[l - 1] * rows(l - 1);
    auto here = rows(l);
    own_[l].triangularView<Eigen::Lower>().solveInPlace(here);
  }
  for (std::size_t l = own_.size(); l-- > 0;) {
    if (l < next_.size()) rows(l).noalias() -= next_[l].transpose() * rows(l + 1);
    auto here = rows(l);
    own_[l].triangularView<Eigen::Lower>().transpose().solveInPlace(here);
  }
}

}  // namespace springproof
