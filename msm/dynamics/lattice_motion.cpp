#include "msm/dynamics/lattice_motion.h"

#include <stdexcept>

#include "msm/dynamics/gpu_arrays.h"
#include "msm/dynamics/lattice_arrays.h"

namespace springproof {
namespace {

bool is_box_of_full_cells(const Network& network) {
  if (network.cells.empty() || !network.filled.empty()) return false;
  const Eigen::RowVector3d size = (network.X.colwise().maxCoeff() - network.X.colwise().minCoeff()) / network.cell_edge;
  const Eigen::Array3d cells = size.array().round();
  return static_cast<double>(network.cells.size()) == cells.prod() &&
         static_cast<double>(network.nodes()) == (cells + 1).prod();
}

}  // namespace

bool LatticeMotion::suits(const MassSpringModel& model, const Viscosity& viscosity, double mass_consistency) {
  const bool of_cells = !viscosity.along_springs() && viscosity.cells().shift == 0 && model.network.filled.empty() &&
                        !model.network.cells.empty();
  const bool averages = !viscosity.acts() && is_box_of_full_cells(model.network);
  return is_lattice_of_springs(model) && (!viscosity.acts() || of_cells) && (mass_consistency == 0 || averages);
}

bool LatticeMotion::suits_gpu(const MassSpringModel& model, const LatticeMotionOptions& options) {
  return is_lattice_of_springs(model) && !dispersion_of(model) && !options.viscosity.acts() &&
         options.mass_consistency == 0;
}

LatticeMotionOptions on_chosen_device(const MassSpringModel& model, LatticeMotionOptions options) {
  if (gpu::wants_gpu() && LatticeMotion::suits_gpu(model, options)) options.device = Device::gpu;
  return options;
}

LatticeMotion::LatticeMotion(const MassSpringModel& model, double density, const LatticeMotionOptions& options) {
  if (!suits(model, options.viscosity, options.mass_consistency))
    throw std::invalid_argument(
        "the lattice kernel is for cubic lattices of springs, with or without volume and hourglass correction or "
        "momentum dispersion, and of averaged springs in full cells; viscosity is that of their cells; boxes have a "
        "share of consistent mass, without "
        "viscosity");
  if (options.device == Device::gpu) {
    if (!suits_gpu(model, options))
      throw std::invalid_argument(
          "on a GPU there is no momentum dispersion, viscosity or share of consistent mass of lattices");
    if (options.precision == Precision::float64)
      arrays_ = std::make_unique<ArraysOnGpu<double>>(model, density);
    else
      arrays_ = std::make_unique<ArraysOnGpu<float>>(model, density);
    return;
  }
  if (options.precision == Precision::float64)
    arrays_ = std::make_unique<ArraysOf<double>>(model, density, options);
  else
    arrays_ = std::make_unique<ArraysOf<float>>(model, density, options);
}

LatticeMotion::LatticeMotion(LatticeMotion&&) noexcept = default;
LatticeMotion& LatticeMotion::operator=(LatticeMotion&&) noexcept = default;
LatticeMotion::~LatticeMotion() = default;

void LatticeMotion::set_conditions(const BoundaryConditions& conditions) { arrays_->set_conditions(conditions); }
void LatticeMotion::move_supports() { arrays_->move_supports(); }
void LatticeMotion::set_state(const NodalVectors& x, const NodalVectors& v) { arrays_->set_state(x, v); }
void LatticeMotion::read(int begin, int end, double* values) const { arrays_->read(begin, end, values); }
void LatticeMotion::write(int begin, int end, const double* values) { arrays_->write(begin, end, values); }
ForceNorms LatticeMotion::advance(long steps, double dt, double damping) {
  return arrays_->advance(steps, dt, damping);
}
NodalVectors LatticeMotion::positions() const { return arrays_->positions(); }
NodalVectors LatticeMotion::velocities() const { return arrays_->velocities(); }
NodalVectors LatticeMotion::forces() { return arrays_->forces(); }
double LatticeMotion::bytes_per_node() const { return arrays_->bytes_per_node(); }
std::string LatticeMotion::description() const { return arrays_->description(); }

}  // namespace springproof
