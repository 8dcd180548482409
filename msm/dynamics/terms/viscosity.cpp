#include "msm/dynamics/terms/viscosity.h"

#include "msm/laws/capabilities.h"
#include "problem/system/input_error.h"

namespace springproof {

AveragedSprings averaged_beside(const MassSpringModel& model, const IsotropicMaterial& material) {
  if (const AveragedSprings* own = averaged_springs_of(model)) return *own;
  AveragedSprings exact;
  exact.shear_modulus = shear_modulus(material);
  exact.lame_lambda = lame_lambda(material);
  exact.hourglass = HourglassStiffness::of_pattern(2, material.poisson_ratio, true, true);
  return exact;
}

Viscosity Viscosity::of(const MassSpringModel& model, const IsotropicMaterial& material, double time) {
  if (!(time >= 0)) throw InputError("viscosity: its time must be >= 0");
  Viscosity viscosity;
  if (time == 0) return viscosity;
  if (const std::string why = lacks(model, Capability::viscosity); !why.empty())
    throw InputError("viscosity does not suit this model: " + why);
  viscosity.time_ = time;
  viscosity.along_springs_ = consists_of<Springs>(model);
  if (const MeasuredCells* own = law_of<MeasuredCells>(model))
    viscosity.measured_ = *own;
  else if (!model.network.cells.empty())
    viscosity.cells_ = averaged_beside(model, material);
  return viscosity;
}

void Viscosity::add_forces(const Network& network, const NodalVectors& x, const NodalVectors& v,
                           NodalVectors& f) const {
  if (!along_springs_) {
    if (of_measured())
      measured_.add_viscous_forces(network, x, v, time_, f);
    else
      cells_.add_viscous_forces(network, x, v, time_, f);
    return hand_back(network.cells.carried, f);
  }
  for (const Spring& s : network.springs) {
    const Eigen::RowVector3d along = (x.row(s.j) - x.row(s.i)).normalized();
    const Eigen::RowVector3d pull = time_ * s.stiffness * (v.row(s.j) - v.row(s.i)).dot(along) * along;
    f.row(s.i) += pull;
    f.row(s.j) -= pull;
  }
}

}  // namespace springproof
