// Explicit dynamics of a lattice by its kernels: the forces and the method of PlainMotion, several times as fast.
#pragma once

#include <memory>

#include "msm/dynamics/motion.h"
#include "msm/laws/laws.h"

namespace springproof {

/// Steps v = (v + dt f/m) / (1 + damping dt), x += dt v, or dt times the velocities of MassAverage.
class LatticeMotion : public Motion {
 public:
  /// Whether there is a kernel for the model: a cubic lattice, whole or with cells missing, of springs with or without
  /// volume and hourglass correction or momentum dispersion that does not lag; or of averaged springs in full cells.
  /// Viscosity: of cells; there is none along springs.  A share of consistent mass: of boxes of full cells, undamped or
  /// damped in proportion to their mass.  No branches that relax.
  static bool suits(const MassSpringModel& model, const MotionOptions& options = {});
  /// The same for a GPU: without momentum dispersion, viscosity, relaxation and shares of consistent mass.
  static bool suits_gpu(const MassSpringModel& model, const MotionOptions& options);

  /// Of the following steps.
  /// @param time_step [s]
  /// @param damping [1/s]
  void set_step(double time_step, double damping) {
    time_step_ = time_step;
    damping_ = damping;
  }

  void set_state(const NodalVectors& x, const NodalVectors& v) override {
    Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor> values(x.rows(), 6);
    values << x - network_.X, v;
    write(0, network_.nodes(), values.data());
  }
  /// Displacement [m], then velocity [m/s] of nodes begin <= n < end, six values per node.
  virtual void read(int begin, int end, double* values) const = 0;
  virtual void write(int begin, int end, const double* values) = 0;

  virtual NodalVectors forces() = 0;          ///< internal forces [N]
  virtual double bytes_per_node() const = 0;  ///< of all stored arrays

 protected:
  /// Nodes of this density [kg/m^3], with the step and the damping of the options.
  LatticeMotion(const MassSpringModel& model, double density, const MotionOptions& options)
      : network_(model.network),
        edge_(model.network.cells.edge),
        density_(density),
        time_step_(options.time_step.value()),
        damping_(options.damping) {}
  BoundaryConditions no_conditions() const {
    const NodalVectors zero = NodalVectors::Zero(network_.nodes(), 3);
    return {std::vector<char>(zero.size(), 0), {}, zero, zero};
  }

  const Network& network_;
  double edge_, density_, time_step_, damping_;
};

/// At rest at X.
/// @param model a model, to which a reference is kept
/// @param density [kg/m^3]
/// @param options with a time step
/// @return the motion, on the device of the options
/// @throws std::invalid_argument unless suits() the options, or for an instruction set that is not usable here.
std::unique_ptr<LatticeMotion> lattice_motion(const MassSpringModel& model, double density,
                                              const MotionOptions& options);

// Its implementations, for a model that they suit.

/// By the kernels of an instruction set.  Nodes are stored in a box of rows, in separate arrays of the components of
/// displacement and velocity.  The forces on a row are complete when the next row is reached and are applied at once.
/// Every spring is computed once.
std::unique_ptr<LatticeMotion> lattice_on_processor(const MassSpringModel& model, double density,
                                                    const MotionOptions& options);
/// By msm/gpu, a node to a thread.
std::unique_ptr<LatticeMotion> lattice_on_gpu(const MassSpringModel& model, double density,
                                              const MotionOptions& options);

/// The options with the GPU as device, if SPRINGPROOF_DEVICE chooses it and LatticeMotion::suits_gpu().
/// @throws InputError as gpu::wants_gpu().
MotionOptions on_chosen_device(const MassSpringModel& model, MotionOptions options);

}  // namespace springproof
