#include "msm/coarsening/measure_cells.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "msm/algebra/dense.h"
#include "msm/coarsening/cell_patches.h"
#include "msm/coarsening/states.h"
#include "msm/embedding/cut_lattice.h"
#include "msm/kernels/workers.h"

namespace springproof {
namespace {

constexpr double most_apart = 2;  // energies of the states by two settings of the fit
constexpr FitSettings in_metric_of_scalars = {0.3, 0.3, 4, true};
// Where materials meet, cells are far from their mean: its metric alone leaves a fifth of the error.
constexpr FitSettings of_several = in_metric_of_scalars, of_several_softer = {0.1, 0.3, 4, true};

/// States of a cell, as the fine lattice has them: one per column.
struct CellStates {
  Eigen::MatrixXd y;  ///< deformations [m]; empty: the cell cannot be measured
  Eigen::MatrixXd s;  ///< stresses [N]
};

/// The states of some cells under loads all over the body, from those of averaged springs, scaled to unit work.
class StatesOfCells {
 public:
  StatesOfCells(const CellPatches& patches, const MassSpringModel& averaged) : patches_(patches) {
    const Eigen::MatrixXd loads = loads_all_over(averaged.network, 0);
    states_ = displacements_under(averaged, loads);
    for (Eigen::Index i = 0; i < states_.cols(); ++i) states_.col(i) /= std::sqrt(states_.col(i).dot(loads.col(i)));
  }

  /// Of the numbers `cells`, into `all`.
  void measure(const std::vector<int>& cells, const MeasureOptions& options, std::vector<CellStates>& all) const {
    std::atomic<std::size_t> next = 0;
    std::atomic<bool> stop = false;
    Workers(options.threads).run([&](int) {
      for (std::size_t i = next++; i < cells.size() && !stop; i = next++) {
        if (options.interrupted && options.interrupted()) stop = true;
        all[cells[i]] = of_cell(cells[i]);
      }
    });
    if (stop) throw std::runtime_error("interrupted");
  }

 private:
  CellStates of_cell(int cell) const {
    const PatchAnswer answer = patches_.answer(cell);
    if (answer.nodes.empty()) return {};
    Eigen::MatrixXd U(answer.deformation.cols(), states_.cols());
    for (std::size_t n = 0; n < answer.nodes.size(); ++n)
      U.middleRows(3 * static_cast<Eigen::Index>(n), 3) = states_.middleRows(3 * answer.nodes[n], 3);
    return {answer.deformation * U, answer.stress * U};
  }

  const CellPatches& patches_;
  Eigen::MatrixXd states_;
};

/// Energy of the states of a cell, twice.
double energy(const DeformationForm& M, const Eigen::MatrixXd& y) { return y.cwiseProduct(M * y).sum(); }

/// Of averaged springs unless the states determine it.
DeformationForm measured_form(const DeformationForm& averaged, const CellStates& states, bool several,
                              int& as_averaged) {
  if (states.y.size() > 0) {
    const DeformationForm form = fit_form(averaged, states.y, states.s, several ? of_several : FitSettings{}),
                          other = fit_form(averaged, states.y, states.s,
                                           several ? of_several_softer : in_metric_of_scalars);
    const double ratio = energy(form, states.y) / energy(other, states.y);
    if (ratio <= most_apart && ratio >= 1 / most_apart) return form;
  }
  ++as_averaged;
  return averaged;
}

double bulk_modulus(const AveragedSprings& law) { return law.lame_lambda + 2 * law.shear_modulus / 3; }

/// Harmonic mean over a cell.
double bulk_modulus(const AveragedSprings& law, const FineCells& fine, int cell) {
  const std::vector<double> shares = shares_of_materials(fine, cell, law.regions.size() + 1);
  double compliance = 0;
  for (std::size_t m = 0; m < shares.size(); ++m) compliance += shares[m] / bulk_modulus(law.in(static_cast<int>(m)));
  return 1 / compliance;
}

/// The form of a cell of averaged springs, of several materials by their mean.
DeformationForm averaged_form(const MeasuredIn& in, int cell) {
  return form_of(springs_in_cell(in.fine, cell, in.law), {in.coarse.grid.edge, in.coarse.cells[cell].filled});
}

ForceLaw averaged_cells(const MeasuredIn& in) {
  if (in.law.regions.empty()) return in.law;
  MeasuredCells mean;
  for (int c = 0; c < static_cast<int>(in.coarse.cells.size()); ++c) mean.add_form(averaged_form(in, c));
  return mean;
}

MassSpringModel held_cells(const MeasuredIn& in, const std::vector<std::string>& held, const ForceLaw& of_cells) {
  MassSpringModel model{cut_lattice(in.coarse, held, {materials_of(in.law).front()}), {of_cells, Anchors{}}};
  set_anchors(in.coarse, held, in.fine, in.law, model.network);
  return model;
}

using NodalView = Eigen::Map<const NodalVectors>;

constexpr int strains = 6;
constexpr double least_scalar = 0.05, largest_scalar = 5;

/// L of a metric.  Strains and patterns are apart in the form of averaged springs, and so in L.
Eigen::MatrixXd scaled_root(const DeformationForm& averaged, const Eigen::MatrixXd& y, const Eigen::MatrixXd& s) {
  Eigen::MatrixXd L = Eigen::MatrixXd(averaged.llt().matrixL());
  const Eigen::MatrixXd z = L.transpose() * y, t = L.triangularView<Eigen::Lower>().solve(s);
  for (const auto& [first, count] : {std::pair(0, strains), std::pair(strains, deformations_of_cell - strains)}) {
    const auto own = z.middleRows(first, count);
    const double norm = own.squaredNorm();
    const double scalar = norm > 0 ? own.cwiseProduct(t.middleRows(first, count)).sum() / norm : 1;
    L.middleRows(first, count) *= std::sqrt(std::clamp(scalar, least_scalar, largest_scalar));
  }
  return L;
}

}  // namespace

MeasuredBody measure_cells(const MeasuredIn& in, const MeasureOptions& options) {
  std::vector<CellStates> states(in.coarse.cells.size());
  std::vector<int> free(states.size()), near_supports;
  std::iota(free.begin(), free.end(), 0);
  if (!in.held.empty()) {
    const CellPatches patches(in.coarse, in.fine, in.law, in.held);
    const std::vector<char> near = patches.near_supports();
    std::erase_if(free, [&](int cell) {
      if (near[cell]) near_supports.push_back(cell);
      return near[cell] != 0;
    });
    StatesOfCells(patches, held_cells(in, in.held, averaged_cells(in))).measure(near_supports, options, states);
  }
  const CellPatches patches(in.coarse, in.fine, in.law);
  StatesOfCells(patches, held_cells(in, {}, averaged_cells(in))).measure(free, options, states);
  MeasuredBody measured;
  for (std::size_t c = 0; c < states.size(); ++c)
    measured.cells.add_form(measured_form(averaged_form(in, static_cast<int>(c)), states[c], !in.law.regions.empty(),
                                          measured.as_averaged));
  const FineTruth truth(in);
  measured.error_of_averaged = truth.error(averaged_cells(in));
  measured.error = truth.error(measured.cells);
  return measured;
}

FineTruth::FineTruth(const MeasuredIn& in) : in_(in), P_(prolongation(in.coarse, in.fine)) {
  constexpr int count = 4, body_forces = 24;  // each a body force, and a force at one place, taken by another
  const MassSpringModel model = held_fine_cells(in.fine, in.held, in.law);
  Network as_wide = model.network;
  as_wide.cells.edge = in.coarse.grid.edge;
  const Eigen::MatrixXd loads = loads_all_over(as_wide, 1);
  load_ = loads.leftCols(count) + loads.middleCols(body_forces + 1, count);
  truth_ = displacements_under(model, load_);
  for (int i = 0; i < count; ++i) {
    const double unit = std::sqrt(truth_.col(i).dot(load_.col(i)));
    load_.col(i) /= unit;
    truth_.col(i) /= unit;
  }
  volume_ = model.network.volume.head(P_.rows());
  for (Eigen::Index n = 0; n < P_.rows(); ++n)
    if (P_.outerIndexPtr()[n] == P_.outerIndexPtr()[n + 1]) volume_[n] = 0;
}

double FineTruth::error(const ForceLaw& of_cells) const {
  const MassSpringModel model = held_cells(in_, in_.held, of_cells);
  const auto nodes_of = [](const Eigen::MatrixXd& fields, Eigen::Index i, Eigen::Index nodes) -> NodalVectors {
    return NodalView(fields.col(i).data(), nodes, 3);
  };
  Eigen::MatrixXd loads(model.network.X.size(), load_.cols());
  for (Eigen::Index i = 0; i < loads.cols(); ++i) {
    NodalVectors load = NodalVectors::Zero(model.network.X.rows(), 3);
    load.topRows(P_.cols()) = P_.transpose() * nodes_of(load_, i, P_.rows());
    loads.col(i) = Eigen::Map<const Eigen::VectorXd>(load.data(), load.size());
  }
  const Eigen::MatrixXd u = displacements_under(model, loads);
  double off = 0, all = 0;
  for (Eigen::Index i = 0; i < u.cols(); ++i) {
    const NodalVectors truth = nodes_of(truth_, i, P_.rows());
    off += volume_.dot((P_ * nodes_of(u, i, P_.cols()) - truth).rowwise().squaredNorm());
    all += volume_.dot(truth.rowwise().squaredNorm());
  }
  return std::sqrt(off / all);
}

std::string describe(const MeasuredBody& measured) {
  constexpr double worth = 0.7;  // of the error of averaged springs
  const std::string says = fmt::format(
      "{} cells measured in cells of a third of their edge: under loads that they were not measured by they "
      "are {:.2g} % off these, averaged springs {:.2g} %",
      measured.cells.form.size() / numbers_of_form, 100 * measured.error, 100 * measured.error_of_averaged);
  if (measured.error > worth * measured.error_of_averaged)
    throw std::invalid_argument("coarsened: " + says +
                                ", which is not worth it; take smaller cells, or averaged springs");
  return measured.as_averaged == 0 ? says : fmt::format("{}; {} keep averaged springs", says, measured.as_averaged);
}

MeasuredCells in_material(const MeasuredCells& measured, const CellSet& cells, const AveragedSprings& of,
                          const AveragedSprings& at, const FineCells* fine) {
  const double shear = at.shear_modulus / of.shear_modulus;
  double bulk = bulk_modulus(at) - shear * bulk_modulus(of);
  MeasuredCells law;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    if (fine) {
      const int cell = static_cast<int>(c);
      bulk = bulk_modulus(at, *fine, cell) - shear * bulk_modulus(of, *fine, cell);
    }
    const CellShape shape = cells.shape(c);
    DeformationForm M = shear * measured.form_of_cell(c);
    M.topLeftCorner<3, 3>().array() += bulk * shape.volume() / (shape.edge * shape.edge);
    law.add_form(M);
  }
  return law;
}

DeformationForm fit_form(const DeformationForm& averaged, const Eigen::MatrixXd& y, const Eigen::MatrixXd& s,
                         const FitSettings& settings) {
  const Eigen::MatrixXd L =
      settings.of_scalars ? scaled_root(averaged, y, s) : Eigen::MatrixXd(averaged.llt().matrixL());
  const Eigen::MatrixXd z = L.transpose() * y, t = L.triangularView<Eigen::Lower>().solve(s);
  Eigen::MatrixXd A = z * z.transpose(), N = t * z.transpose();
  const double rho = settings.ridge * A.trace() / deformations_of_cell;
  if (!(rho > 0)) return averaged;
  A.diagonal().array() += rho;
  N.diagonal().array() += rho;
  const Eigenpairs of_A = symmetric_eigenpairs(A);  // C A + A C = N + N^T
  Eigen::MatrixXd C = of_A.vectors.transpose() * (N + N.transpose()) * of_A.vectors;
  for (int i = 0; i < deformations_of_cell; ++i)
    for (int j = 0; j < deformations_of_cell; ++j) C(i, j) /= of_A.values[i] + of_A.values[j];
  C = of_A.vectors * C * of_A.vectors.transpose();
  const Eigenpairs of_C = symmetric_eigenpairs((C + C.transpose()) / 2);
  const Eigen::VectorXd values = of_C.values.cwiseMax(settings.least).cwiseMin(settings.largest);
  const Eigen::MatrixXd root = L * of_C.vectors;
  return root * values.asDiagonal() * root.transpose();
}

}  // namespace springproof
