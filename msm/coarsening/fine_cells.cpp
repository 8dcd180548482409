#include "msm/coarsening/fine_cells.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace springproof {
namespace {

using CellsOfCube = std::map<std::array<int, 3>, std::vector<int>>;

Vec3 centroid(const CutBody& body, int cell) {
  return body.centre(cell) + body.grid.edge * body.cells[cell].filled.mean;
}

/// The coarse cell that holds a fine one.
int holder(const CutBody& coarse, const CellsOfCube& cells_of, const FineCells& fine, int cell) {
  std::array<int, 3> cube = fine.body.cells[cell].index;
  for (int& i : cube) i /= fine.ratio;
  const auto here = cells_of.find(cube);
  if (here == cells_of.end()) return -1;
  const std::vector<int>& parts = here->second;
  if (parts.size() == 1) return parts.front();
  const Vec3 middle = centroid(fine.body, cell);
  const int found = coarse.place(middle).cell;
  if (std::find(parts.begin(), parts.end(), found) != parts.end()) return found;
  const auto distance = [&](int part) { return (centroid(coarse, part) - middle).norm(); };
  return *std::min_element(parts.begin(), parts.end(), [&](int a, int b) { return distance(a) < distance(b); });
}

}  // namespace

FineCells fine_cells(const CutBody& coarse, const Mesh& mesh, int ratio) {
  VoxelGrid grid = coarse.grid;
  grid.edge /= ratio;
  for (int& n : grid.cells) n *= ratio;
  FineCells fine{cut_body(grid, mesh), ratio, {}, std::vector<std::vector<int>>(coarse.cells.size())};
  CellsOfCube cells_of;
  for (std::size_t c = 0; c < coarse.cells.size(); ++c) cells_of[coarse.cells[c].index].push_back(static_cast<int>(c));
  for (int f = 0; f < static_cast<int>(fine.body.cells.size()); ++f) {
    const int in = holder(coarse, cells_of, fine, f);
    fine.in.push_back(in);
    if (in >= 0) fine.of[in].push_back(f);
  }
  return fine;
}

Eigen::SparseMatrix<double, Eigen::RowMajor> prolongation(const CutBody& coarse, const FineCells& fine) {
  std::vector<char> done(fine.body.points.rows(), 0);
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t f = 0; f < fine.in.size(); ++f) {
    if (fine.in[f] < 0) continue;
    for (const int n : fine.body.cells[f].corners) {
      if (done[n]) continue;
      done[n] = 1;
      const std::array<double, 8> w = coarse.weights(fine.in[f], fine.body.points.row(n).transpose());
      for (int a = 0; a < 8; ++a) entries.emplace_back(n, coarse.cells[fine.in[f]].corners[a], w[a]);
    }
  }
  Eigen::SparseMatrix<double, Eigen::RowMajor> P(fine.body.points.rows(), coarse.points.rows());
  P.setFromTriplets(entries.begin(), entries.end());
  return P;
}

std::vector<double> shares_of_materials(const FineCells& fine, int cell, std::size_t materials) {
  std::vector<double> shares(materials, 0);
  double all = 0;
  for (const int f : fine.of[cell]) {
    const CutCell& part = fine.body.cells[f];
    shares[part.material] += part.filled.fraction;
    all += part.filled.fraction;
  }
  if (all == 0) shares[0] = all = 1;
  for (double& share : shares) share /= all;
  return shares;
}

namespace {

/// Between the arithmetic and the geometric mean of moduli.
class MeanModulus {
 public:
  void add(double share, double modulus) {
    sum_ += share * modulus;
    logs_ += share * std::log(modulus);
  }
  double value() const { return std::sqrt(sum_ * std::exp(logs_)); }

 private:
  double sum_ = 0, logs_ = 0;
};

}  // namespace

AveragedSprings springs_in_cell(const FineCells& fine, int cell, const AveragedSprings& law) {
  if (law.regions.empty()) return law;
  const std::vector<double> shares = shares_of_materials(fine, cell, law.regions.size() + 1);
  AveragedSprings mean = law;
  mean.regions.clear();
  mean.hourglass = {0, 0, 0, 0, 0};
  MeanModulus G, K;
  for (std::size_t m = 0; m < shares.size(); ++m) {
    const AveragedSprings& of = law.in(static_cast<int>(m));
    G.add(shares[m], of.shear_modulus);
    K.add(shares[m], of.lame_lambda + 2 * of.shear_modulus / 3);
    for (double HourglassStiffness::*const mode :
         {&HourglassStiffness::bending, &HourglassStiffness::coupling, &HourglassStiffness::torsion,
          &HourglassStiffness::twist, &HourglassStiffness::warping})
      mean.hourglass.*mode += shares[m] * of.hourglass.*mode;
  }
  mean.shear_modulus = G.value();
  mean.lame_lambda = K.value() - 2 * G.value() / 3;
  return mean;
}

}  // namespace springproof
