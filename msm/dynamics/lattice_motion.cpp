#include "msm/dynamics/lattice_motion.h"

#include <stdexcept>

#include "msm/gpu/gpu.h"
#include "msm/kernels/lattice_layout.h"
#include "msm/laws/capabilities.h"

namespace springproof {
namespace {

bool is_box_of_full_cells(const Network& network) {
  if (network.cells.empty() || network.cells.cut()) return false;
  const Eigen::RowVector3d size =
      (network.X.colwise().maxCoeff() - network.X.colwise().minCoeff()) / network.cells.edge;
  const Eigen::Array3d cells = size.array().round();
  return static_cast<double>(network.cells.size()) == cells.prod() &&
         static_cast<double>(network.nodes()) == (cells + 1).prod();
}

}  // namespace

bool LatticeMotion::suits(const MassSpringModel& model, const MotionOptions& options) {
  const Viscosity& viscosity = options.viscosity;
  const bool of_cells = !viscosity.along_springs() && viscosity.cells().shift == 0 && !model.network.cells.cut() &&
                        !model.network.cells.empty();
  const bool averages = !viscosity.acts() && is_box_of_full_cells(model.network);
  return !options.lagged && !options.relaxation.acts() && is_lattice_of_springs(model) &&
         (!viscosity.acts() || of_cells) && (options.mass_consistency == 0 || averages);
}

bool LatticeMotion::suits_gpu(const MassSpringModel& model, const MotionOptions& options) {
  return is_lattice_of_springs(model) && can(model, Capability::gpu) && !options.viscosity.acts() &&
         !options.relaxation.acts() && options.mass_consistency == 0;
}

MotionOptions on_chosen_device(const MassSpringModel& model, MotionOptions options) {
  if (gpu::wants_gpu() && LatticeMotion::suits_gpu(model, options)) options.device = Device::gpu;
  return options;
}

std::unique_ptr<LatticeMotion> lattice_motion(const MassSpringModel& model, double density,
                                              const MotionOptions& options) {
  if (!LatticeMotion::suits(model, options))
    throw std::invalid_argument(
        "the lattice kernel is for cubic lattices of springs, with or without volume and hourglass correction or "
        "momentum dispersion, and of averaged springs in full cells; viscosity is that of their cells; boxes have a "
        "share of consistent mass, without "
        "viscosity; nothing relaxes");
  if (options.device == Device::processor) return lattice_on_processor(model, density, options);
  if (!LatticeMotion::suits_gpu(model, options))
    throw std::invalid_argument(
        "on a GPU there is no momentum dispersion, viscosity, relaxation or share of consistent mass of lattices");
  return lattice_on_gpu(model, density, options);
}

}  // namespace springproof
