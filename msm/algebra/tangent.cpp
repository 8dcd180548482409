#include "msm/algebra/tangent.h"

namespace springproof {
namespace {

/// The columns i with number[i] >= 0, renumbered by `number`.
NodalForms columns(const NodalForms& forms, const std::vector<int>& number, int unknowns) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(static_cast<std::size_t>(forms.nonZeros()));
  for (int n = 0; n < forms.outerSize(); ++n)
    for (NodalForms::InnerIterator e(forms, n); e; ++e)
      if (number[e.col()] >= 0) entries.emplace_back(n, number[e.col()], e.value());
  NodalForms kept(forms.rows(), unknowns);
  kept.setFromTriplets(entries.begin(), entries.end());
  return kept;
}

}  // namespace

void Tangent::multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const {
  local.multiply(x, y);
  if (dispersive()) y += outflow.transpose() * (inflow * x);
}

std::vector<Eigen::Matrix3d> Tangent::node_blocks() const {
  std::vector<Eigen::Matrix3d> blocks(local.nodes());
  for (int n = 0; n < local.nodes(); ++n) blocks[n] = local.at(n, n);
  const auto next_node = [](NodalForms::InnerIterator& e, int node) {  // the entries of a node in a row
    Eigen::Vector3d form = Eigen::Vector3d::Zero();
    for (; e && e.col() / 3 <= node; ++e)
      if (e.col() / 3 == node) form[e.col() % 3] = e.value();
    return form;
  };
  for (int n = 0; n < inflow.outerSize(); ++n)
    for (NodalForms::InnerIterator in(inflow, n), out(outflow, n); in;) {
      const int node = static_cast<int>(in.col() / 3);
      const Eigen::Vector3d a = next_node(in, node), c = next_node(out, node);
      blocks[node] += c * a.transpose();
    }
  return blocks;
}

Eigen::VectorXd Tangent::diagonal() const {
  Eigen::VectorXd d(3 * local.nodes());
  const std::vector<Eigen::Matrix3d> blocks = node_blocks();
  for (int n = 0; n < local.nodes(); ++n) d.segment<3>(3 * n) = blocks[n].diagonal();
  return d;
}

Eigen::SparseMatrix<double> Tangent::lower_triangle(const std::vector<int>& number, int unknowns) const {
  Eigen::SparseMatrix<double> L = local.lower_triangle(number, unknowns);
  if (!dispersive()) return L;
  const NodalForms in = columns(inflow, number, unknowns), out = columns(outflow, number, unknowns);
  const Eigen::SparseMatrix<double> coupling = (NodalForms(out.transpose()) * in).eval();
  return L + Eigen::SparseMatrix<double>(coupling.triangularView<Eigen::Lower>());
}

}  // namespace springproof
