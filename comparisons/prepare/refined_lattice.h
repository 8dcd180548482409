// Lattices that are refined until they promise an accuracy.
#pragma once

#include "comparisons/prepare/prepared_case.h"

namespace springproof {

/// A body in cells of several sizes.
struct RefinedBody {
  CutBody cut;
  double promised = 0;   ///< relative error of the displacement, the largest over the case's materials
  bool reached = false;  ///< the accuracy that was asked for
};

/// Halves cells of `grid` where the stress differs most from that recovered at their nodes, until the promised error
/// (msm/measure/promised_error.h) of the first model of cut cells is at most `accuracy` for each material of the case
/// (at rest, displacements small), cells have been halved four times or there are 100,000.
/// @throws InputError if the loads cannot be applied, or leave a rigid motion.
RefinedBody refine_until(const PreparedCase& prepared, VoxelGrid grid, const Mesh& body, double accuracy);

}  // namespace springproof
