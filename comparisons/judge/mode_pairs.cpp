#include "comparisons/judge/mode_pairs.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

namespace springproof {
namespace {

/// Columns: shapes, weighted so that the dot product is that of the weights, and of unit length.
Eigen::MatrixXd unit_columns(const ModeSet& modes, const Eigen::VectorXd& weights) {
  Eigen::MatrixXd columns(3 * weights.size(), static_cast<Eigen::Index>(modes.shapes.size()));
  for (Eigen::Index j = 0; j < columns.cols(); ++j) {
    const NodalVectors weighted = weights.cwiseSqrt().asDiagonal() * modes.shapes[j];
    columns.col(j) = Eigen::Map<const Eigen::VectorXd>(weighted.data(), weighted.size()).normalized();
  }
  return columns;
}

/// For each mode the first and one past the last of its multiplet.
std::vector<std::pair<Eigen::Index, Eigen::Index>> multiplets(const std::vector<double>& f, double width) {
  std::vector<std::pair<Eigen::Index, Eigen::Index>> of;
  for (std::size_t begin = 0, end = 0; begin < f.size(); begin = end) {
    end = begin + 1;
    while (end < f.size() && f[end] < (1 + width) * f[end - 1]) ++end;
    for (std::size_t i = begin; i < end; ++i) of.emplace_back(begin, end);
  }
  return of;
}

/// (i, j): cosine^2 of the angle between a mode j of `b` and the span of the multiplet of mode i of `a`.
Eigen::MatrixXd shares(const Eigen::MatrixXd& a, const std::vector<double>& frequencies, const Eigen::MatrixXd& b,
                       double width) {
  Eigen::MatrixXd out(a.cols(), b.cols());
  const auto groups = multiplets(frequencies, width);
  for (Eigen::Index i = 0; i < a.cols(); ++i) {
    const auto [begin, end] = groups[i];
    const Eigen::MatrixXd span = a.middleCols(begin, end - begin);
    const Eigen::MatrixXd Q = Eigen::HouseholderQR<Eigen::MatrixXd>(span).householderQ() *
                              Eigen::MatrixXd::Identity(span.rows(), span.cols());
    out.row(i) = (Q.transpose() * b).colwise().squaredNorm();
  }
  return out;
}

/// Column assigned to each row at the least sum of costs, rows <= columns: shortest augmenting paths (Kuhn 1955,
/// Munkres 1957), with potentials of rows and columns.
std::vector<Eigen::Index> assigned(const Eigen::MatrixXd& cost) {
  const Eigen::Index n = cost.rows(), m = cost.cols();
  std::vector<double> of_row(n + 1, 0), of_column(m + 1, 0);
  std::vector<Eigen::Index> row_at(m + 1, 0), before(m + 1, 0);  // numbered from 1; 0: none
  for (Eigen::Index row = 1; row <= n; ++row) {
    std::vector<double> distance(m + 1, std::numeric_limits<double>::infinity());
    std::vector<char> done(m + 1, 0);
    Eigen::Index at = 0;
    row_at[0] = row;
    do {
      done[at] = 1;
      Eigen::Index next = 0;
      double least = std::numeric_limits<double>::infinity();
      for (Eigen::Index c = 1; c <= m; ++c) {
        if (done[c]) continue;
        const double reduced = cost(row_at[at] - 1, c - 1) - of_row[row_at[at]] - of_column[c];
        if (reduced < distance[c]) distance[c] = reduced, before[c] = at;
        if (distance[c] < least) least = distance[c], next = c;
      }
      for (Eigen::Index c = 0; c <= m; ++c)
        if (done[c])
          of_row[row_at[c]] += least, of_column[c] -= least;
        else
          distance[c] -= least;
      at = next;
    } while (row_at[at] != 0);
    for (; at != 0; at = before[at]) row_at[at] = row_at[before[at]];
  }
  std::vector<Eigen::Index> column(n, 0);
  for (Eigen::Index c = 1; c <= m; ++c)
    if (row_at[c] > 0) column[row_at[c] - 1] = c - 1;
  return column;
}

}  // namespace

std::vector<ModePair> pair_modes(const ModeSet& reference, const ModeSet& computed, const Eigen::VectorXd& weights) {
  const Eigen::MatrixXd a = unit_columns(reference, weights), b = unit_columns(computed, weights);
  // Whichever is the multiple one: modes that are apart here may coincide there, and then mix.
  const auto macs = [&](double width) -> Eigen::MatrixXd {
    return shares(a, reference.frequencies, b, width).cwiseMax(shares(b, computed.frequencies, a, width).transpose());
  };
  const Eigen::MatrixXd mac = macs(multiplet_width), similar = macs(equal_frequencies);
  constexpr double shape = 1e-2, order = 1e-6;  // weights of what decides between equal MACs
  const Eigen::Index rows = mac.rows(), columns = std::max(mac.cols(), rows);
  Eigen::MatrixXd cost = Eigen::MatrixXd::Constant(rows, columns, 2);  // columns beyond the computed: no partner
  for (Eigen::Index i = 0; i < rows; ++i)
    for (Eigen::Index j = 0; j < mac.cols(); ++j)
      cost(i, j) = 1 - mac(i, j) + shape * (1 - similar(i, j)) +
                   order * std::pow(std::log(computed.frequencies[j] / reference.frequencies[i]), 2);
  const std::vector<Eigen::Index> column = assigned(cost);
  std::vector<ModePair> pairs(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const bool is_there = column[i] < mac.cols();
    pairs[i].mac = is_there ? mac(i, column[i]) : mac.cols() > 0 ? mac.row(i).maxCoeff() : 0;
    if (is_there && pairs[i].mac >= least_mac) pairs[i].partner = static_cast<std::size_t>(column[i]);
  }
  return pairs;
}

}  // namespace springproof
