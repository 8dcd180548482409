#include "msm/parameters/patch_conditions.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "msm/algebra/dense.h"

namespace springproof {
namespace {

constexpr int motions = 6;            // of a rigid body
constexpr int products = 56;          // of three of them
constexpr double least_width = 4;     // of a box, in spacings
constexpr double most_boxes = 24;     // so that the matrix, of up to 1,200 unknowns, is factored in 0.1 s
constexpr double independent = 1e-6;  // least eigenvalue of the products' scalar products, of the largest

/// Velocity at x of a translation along or a rotation about an axis.
Vec3 velocity(int motion, const Vec3& x) {
  return motion < 3 ? Vec3(Vec3::Unit(motion)) : Vec3(Vec3::Unit(motion - 3).cross(x));
}

Eigen::Matrix<double, patch_moments, products> killing_tensors(const Vec3& x) {
  Eigen::Matrix<double, patch_moments, products> all;
  int column = 0;
  for (int a = 0; a < motions; ++a)
    for (int b = a; b < motions; ++b)
      for (int c = b; c < motions; ++c)
        all.col(column++) = symmetric_product(velocity(a, x), velocity(b, x), velocity(c, x));
  return all;
}

/// Nodes by boxes of equal size.
std::vector<std::vector<int>> divided(const NodalVectors& X, double width) {
  const Eigen::RowVector3d low = X.colwise().minCoeff(), extent = X.colwise().maxCoeff() - low;
  std::map<std::array<int, 3>, std::vector<int>> boxes;
  for (int n = 0; n < X.rows(); ++n) {
    std::array<int, 3> at{};
    for (int a = 0; a < 3; ++a) {
      const int count = std::max(1, static_cast<int>(std::lround(extent[a] / width)));
      if (count > 1) at[a] = std::min(count - 1, static_cast<int>((X(n, a) - low[a]) / extent[a] * count));
    }
    boxes[at].push_back(n);
  }
  std::vector<std::vector<int>> parts;
  for (auto& [at, nodes] : boxes) parts.push_back(std::move(nodes));
  return parts;
}

}  // namespace

PatchMoments symmetric_product(const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto component = [&](int i, int j, int k) {
    return (a[i] * (b[j] * c[k] + b[k] * c[j]) + a[j] * (b[i] * c[k] + b[k] * c[i]) +
            a[k] * (b[i] * c[j] + b[j] * c[i])) /
           6;
  };
  const double w = std::sqrt(3.0);
  PatchMoments m;
  m << component(0, 0, 0), component(1, 1, 1), component(2, 2, 2), w * component(0, 0, 1), w * component(0, 0, 2),
      w * component(1, 1, 0), w * component(1, 1, 2), w * component(2, 2, 0), w * component(2, 2, 1),
      std::sqrt(6.0) * component(0, 1, 2);
  return m;
}

PatchMoments patch_traction(const Vec3& A) {
  PatchMoments m = PatchMoments::Zero();
  for (int d = 0; d < 3; ++d) m += 3 * symmetric_product(Vec3::Unit(d), Vec3::Unit(d), A);
  return m;
}

KillingSpace::KillingSpace(const NodalVectors& X, double spacing) : box_(X.rows()), basis_(X.rows()) {
  if (X.rows() == 0) return;
  double width = least_width * spacing;
  std::vector<std::vector<int>> parts = divided(X, width);
  while (static_cast<double>(parts.size()) > most_boxes) parts = divided(X, width *= 1.1);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const std::vector<int>& nodes = parts[p];
    Vec3 middle = Vec3::Zero();
    for (const int n : nodes) middle += X.row(n).transpose() / static_cast<double>(nodes.size());
    Eigen::MatrixXd squares = Eigen::MatrixXd::Zero(products, products);
    for (const int n : nodes) {
      const auto tensors = killing_tensors((X.row(n).transpose() - middle) / width);
      squares += tensors.transpose() * tensors;
    }
    const Eigenpairs eigen = symmetric_eigenpairs(squares);
    const auto kept = (eigen.values.array() > independent * eigen.values[products - 1]).count();
    const Eigen::MatrixXd combined =
        eigen.vectors.rightCols(kept) * eigen.values.tail(kept).cwiseSqrt().cwiseInverse().asDiagonal();
    for (const int n : nodes) {
      box_[n] = static_cast<int>(p);
      basis_[n] = (killing_tensors((X.row(n).transpose() - middle) / width) * combined).cast<float>();
    }
    first_.push_back(unknowns_);
    unknowns_ += static_cast<int>(kept);
  }
}

void KillingSpace::factor(const std::vector<PatchColumn>& columns, const Eigen::VectorXd& W, const Eigen::VectorXd& D) {
  if (unknowns_ == 0) return;
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(unknowns_, unknowns_);  // its lower triangle
  for (std::size_t s = 0; s < columns.size(); ++s) {
    int i = columns[s].i, j = columns[s].j;
    if (box_[i] == box_[j]) continue;  // not seen
    if (box_[i] < box_[j]) std::swap(i, j);
    const double w = std::sqrt(W[static_cast<Eigen::Index>(s)]);
    const Eigen::VectorXd at_i = w * (basis_[i].transpose().cast<double>() * columns[s].column);
    const Eigen::VectorXd at_j = w * (basis_[j].transpose().cast<double>() * columns[s].column);
    A.block(first(i), first(i), at_i.size(), at_i.size()).selfadjointView<Eigen::Lower>().rankUpdate(at_i);
    A.block(first(j), first(j), at_j.size(), at_j.size()).selfadjointView<Eigen::Lower>().rankUpdate(at_j);
    A.block(first(i), first(j), at_i.size(), at_j.size()).noalias() -= at_i * at_j.transpose();
  }
  for (std::size_t n = 0; n < basis_.size(); ++n) {
    const Eigen::Index size = basis_[n].cols(), at = first(static_cast<int>(n));
    A.block(at, at, size, size)
        .selfadjointView<Eigen::Lower>()
        .rankUpdate(basis_[n].transpose().cast<double>(), D[patch_moments * static_cast<Eigen::Index>(n)]);
  }
  factor_ = A.llt().matrixL().toDenseMatrix().cast<float>();
}

void KillingSpace::add(const Eigen::VectorXf& r, Eigen::VectorXf& z) const {
  if (unknowns_ == 0) return;
  Eigen::VectorXf c = Eigen::VectorXf::Zero(unknowns_);
  const auto part = [&](std::size_t n) { return c.segment(first(static_cast<int>(n)), basis_[n].cols()); };
  for (std::size_t n = 0; n < basis_.size(); ++n)
    part(n).noalias() += basis_[n].transpose() * r.segment<patch_moments>(patch_moments * static_cast<Eigen::Index>(n));
  factor_.triangularView<Eigen::Lower>().solveInPlace(c);
  factor_.triangularView<Eigen::Lower>().transpose().solveInPlace(c);
  for (std::size_t n = 0; n < basis_.size(); ++n)
    z.segment<patch_moments>(patch_moments * static_cast<Eigen::Index>(n)).noalias() += basis_[n] * part(n);
}

}  // namespace springproof
