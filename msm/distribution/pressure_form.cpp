#include "msm/distribution/pressure_form.h"

namespace springproof {
namespace {

/// kappa > 0 of each material, which it takes from the model's laws; 0 where springs bear the volume, as nu <= 1/4.
std::vector<double> take_volume_terms(MassSpringModel& model) {
  erase_laws<MomentumDispersion>(model);
  if (auto* averaged = law_of<AveragedSprings>(model)) {
    MixedParts parts = mixed_parts(*averaged);
    *averaged = std::move(parts.springs);
    return std::move(parts.kappa);
  }
  std::vector<double> kappa;
  const auto take = [&](VolumeCorrection& of) {
    kappa.push_back(std::max(0.0, of.kappa));
    of.kappa = std::min(0.0, of.kappa);
  };
  if (auto* volume = law_of<VolumeCorrection>(model)) {
    take(*volume);
    for (VolumeCorrection& of : volume->regions) take(of);
  }
  return kappa;
}

/// dV/du of a cell at rest [m^2].
Eigen::Matrix<double, 24, 1> volume_gradient(const MassSpringModel& model, std::size_t cell) {
  const Network& network = model.network;
  if (averaged_springs_of(model)) return cell_volume(network, cell, network.X).gradient;
  Eigen::Matrix<double, 24, 1> gradient;
  const MeanEdgeVolume volume = mean_edge_volume(network.cells.corners[cell], network.X);
  for (int n = 0; n < 8; ++n) gradient.segment<3>(3 * n) = volume.gradient.row(n).transpose();
  return gradient;
}

void set_pressures_of_cells(const MassSpringModel& model, const std::vector<double>& kappa, PressureForm& form) {
  const Network& network = model.network;
  const Carriers carriers = carriers_of(network.nodes(), network.cells.carried);
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(24 * network.cells.size());
  form.C = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(network.cells.size()));
  for (std::size_t c = 0; c < network.cells.size(); ++c) {
    const int row = static_cast<int>(c);
    const double of_cell = kappa[network.cells.material(c)];
    if (of_cell == 0) continue;
    const Eigen::Matrix<double, 24, 1> gradient = volume_gradient(model, c);
    for (int n = 0; n < 8; ++n) {
      for_each_carrier(carriers, network.cells.corners[c][n], [&](int node, double weight) {
        for (int d = 0; d < 3; ++d) entries.emplace_back(row, 3 * node + d, weight * gradient[3 * n + d]);
      });
    }
    form.C[row] = filled_volume(network, c) / of_cell;
  }
  form.B.resize(form.C.size(), 3 * network.nodes());
  form.B.setFromTriplets(entries.begin(), entries.end());
}

/// Inflow and outflow of the symmetric form are the same but for a factor per node, which is 1 / C.
void set_pressures_of_nodes(const MassSpringModel& model, PressureForm& form) {
  Tangent flow;
  dispersion_of(model)->add_flow(model.network, model.network.X, flow);
  form.C = Eigen::VectorXd::Zero(flow.inflow.rows());
  for (int n = 0; n < flow.inflow.outerSize(); ++n) {
    double in = 0, out = 0;
    for (NodalForms::InnerIterator i(flow.inflow, n), o(flow.outflow, n); i; ++i, ++o) {
      in += i.value() * i.value();
      out += o.value() * i.value();
    }
    if (out > 0) form.C[n] = in / out;
  }
  form.B = std::move(flow.inflow);
}

}  // namespace

PressureForm pressure_form(const MassSpringModel& model) {
  PressureForm form{model, {}, {}};
  const std::vector<double> kappa = take_volume_terms(form.springs);
  dispersion_of(model) ? set_pressures_of_nodes(model, form) : set_pressures_of_cells(model, kappa, form);
  return form;
}

}  // namespace springproof
