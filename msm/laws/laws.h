// The one list of force laws.  A law is a plain value; adding one here gives it the whole law test suite.
#pragma once

#include <variant>
#include <vector>

#include "msm/laws/hourglass_correction.h"
#include "msm/laws/springs.h"
#include "msm/laws/volume_correction.h"

namespace springproof {

using ForceLaw = std::variant<Springs, VolumeCorrection, HourglassCorrection>;

/// A mass-spring model: a network and what acts in it.
struct MassSpringModel {
  Network network;
  std::vector<ForceLaw> laws;
  bool small_displacements_only = false;  ///< holds for linear kinematics only
};

double energy(const MassSpringModel& model, const NodalVectors& x);              ///< elastic energy [J]
NodalVectors forces(const MassSpringModel& model, const NodalVectors& x);        ///< internal forces -dE/dx [N]
BlockMatrix tangent(const MassSpringModel& model, const NodalVectors& x);        ///< d2E/dx2 [N/m]

/// Refills a matrix made by tangent() at another state, keeping its pattern.
void update_tangent(const MassSpringModel& model, const NodalVectors& x, BlockMatrix& K);

}  // namespace springproof
