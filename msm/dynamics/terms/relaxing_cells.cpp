#include "msm/dynamics/terms/relaxing_cells.h"

#include "msm/dynamics/terms/viscosity.h"
#include "msm/laws/capabilities.h"
#include "problem/system/input_error.h"

namespace springproof {
namespace {

/// What a sum of branches of 1 adds to the hourglass stiffness of the long-time solid: bending modes are stiff as E /
/// (1 - nu^2), whose bulk modulus does not relax, torsional ones as G.
HourglassStiffness of_branches(const HourglassStiffness& relaxed, const IsotropicMaterial& material, double sum) {
  const double nu = material.poisson_ratio, sudden = with_shear(material, 1 + sum).poisson_ratio;
  const auto bending = [](double ratio) { return HourglassStiffness::of_pattern(2, ratio, true, true).bending; };
  HourglassStiffness k = relaxed;
  k.bending *= ((1 + sum) * bending(sudden) - bending(nu)) / (sum * bending(nu));
  if (relaxed.coupling == nu * relaxed.bending)  // exact for the solid
    k.coupling = relaxed.bending * ((1 + sum) * sudden * bending(sudden) - nu * bending(nu)) / (sum * bending(nu));
  return k;
}

}  // namespace

RelaxingCells RelaxingCells::of(const MassSpringModel& model, const IsotropicMaterial& material,
                                const Relaxation& relaxation) {
  if (!relaxation.acts()) return {};
  if (const std::string why = lacks(model, Capability::relaxation); !why.empty())
    throw InputError("relaxation does not suit this model: " + why);
  if (const MeasuredCells* own = law_of<MeasuredCells>(model)) {
    RelaxingCells out{relaxation, {}, {}};
    for (std::size_t c = 0; c < model.network.cells.size(); ++c)
      out.measured.add_form(without_volume(own->form_of_cell(c)));
    return out;
  }
  RelaxingCells out{relaxation, averaged_beside(model, material), {}};
  out.cells.hourglass = of_branches(out.cells.hourglass, material, relaxation.instantaneous() - 1);
  return out;
}

Overstrains::Overstrains(const Network& network, const RelaxingCells& relaxing)
    : network_(network), branches_(relaxing.relaxation.branches), forms_(relaxing.measured) {
  if (!acts()) return;
  if (relaxing.of_measured())
    measure_ = StrainOfCell::logarithmic;
  else
    for (std::size_t c = 0; c < network.cells.size(); ++c)
      forms_.add_form(without_volume(form_of(relaxing.cells, shape(c))));
  strains_.resize(network.cells.size());
  relax(network.X);
}

Deformations Overstrains::strains(std::size_t cell, const NodalVectors& x) const {
  return deformations(measure_, {shape(cell), network_.cells.corners[cell]}, x);
}

template <class Overstrain>
Deformations Overstrains::sum(std::size_t cell, double dt, const Overstrain& of_branch) const {
  Deformations Q = Deformations::Zero();
  for (std::size_t i = 0; i < branches_.size(); ++i)
    Q += branches_[i].share *
         of_branch(BranchStep::of(dt / branches_[i].time), of_branches_[branches_.size() * cell + i]);
  return Q;
}

void Overstrains::relax(const NodalVectors& x) {
  for (std::size_t c = 0; c < strains_.size(); ++c) strains_[c] = strains(c, x);
  of_branches_.assign(branches_.size() * strains_.size(), Deformations::Zero());
  dissipated_ = 0;
}

void Overstrains::add_forces(const NodalVectors& x, double dt, NodalVectors& f) const {
  if (!acts()) return;
  for (std::size_t c = 0; c < strains_.size(); ++c) {
    const Deformations change = strains(c, x) - strains_[c],
                       Q = sum(c, dt,
                               [&](const BranchStep&step, const Deformations&of) { return step.end(of, change); });
    add_forces_of(measure_, forms_.form_of_cell(c) * Q, {shape(c), network_.cells.corners[c]}, x, f);
  }
  hand_back(network_.cells.carried, f);
}

void Overstrains::add_mean_forces(const NodalVectors& x0, const NodalVectors& x1, double dt, NodalVectors& f) const {
  if (!acts()) return;
  for (std::size_t c = 0; c < strains_.size(); ++c) {
    const Deformations change = strains(c, x1) - strains_[c],
                       Q = sum(c, dt,
                               [&](const BranchStep&step, const Deformations&of) { return step.mean(of, change); });
    add_mean_forces_of(measure_, forms_.form_of_cell(c) * Q, {shape(c), network_.cells.corners[c]}, x0, x1, f);
  }
  hand_back(network_.cells.carried, f);
}

void Overstrains::advance(const NodalVectors& x, double dt) {
  for (std::size_t c = 0; c < strains_.size(); ++c) {
    const DeformationForm M = forms_.form_of_cell(c);
    const Deformations now = strains(c, x), change = now - strains_[c];
    for (std::size_t i = 0; i < branches_.size(); ++i) {
      Deformations& Q = of_branches_[branches_.size() * c + i];
      const BranchStep step = BranchStep::of(dt / branches_[i].time);
      const Deformations mean = step.mean(Q, change), end = step.end(Q, change);
      dissipated_ += branches_[i].share * ((M * mean).dot(change) - (M * (end + Q)).dot(end - Q) / 2);
      Q = end;
    }
    strains_[c] = now;
  }
}

double Overstrains::energy() const {
  double sum = 0;
  for (std::size_t c = 0; c < strains_.size(); ++c) {
    const DeformationForm M = forms_.form_of_cell(c);
    for (std::size_t i = 0; i < branches_.size(); ++i) {
      const Deformations& Q = of_branches_[branches_.size() * c + i];
      sum += branches_[i].share * Q.dot(M * Q) / 2;
    }
  }
  return sum;
}

}  // namespace springproof
