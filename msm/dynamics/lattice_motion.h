// Explicit dynamics of a lattice: the same forces and the same method as the plain loops of run_dynamics(), several
// times as fast.
#pragma once

#include <memory>
#include <string>

#include "msm/dynamics/viscosity.h"
#include "msm/embedding/boundary.h"
#include "msm/kernels/instruction_set.h"
#include "msm/laws/laws.h"

namespace springproof {

enum class Precision { float64, float32 };

/// Where steps are made.  A GPU: the one that the library was built for (SPRINGPROOF_CUDA); in a library without one
/// its code runs on the processor, thread by thread, which is slow.
enum class Device { processor, gpu };

struct LatticeMotionOptions {
  Precision precision = Precision::float64;  ///< float32: forces to 1e-6 of the largest, twice as fast
  int threads = 1;                           ///< at most one per plane of nodes; momentum dispersion uses one
  InstructionSet instructions = instruction_set();
  Viscosity viscosity = {};
  double mass_consistency = 0;  ///< share of consistent mass: MassAverage
  Device device = Device::processor;
};

/// The same on the GPU, if SPRINGPROOF_DEVICE chooses it and LatticeMotion::suits_gpu().
/// @throws InputError as gpu::wants_gpu().
LatticeMotionOptions on_chosen_device(const MassSpringModel& model, LatticeMotionOptions options);

/// Norms of the sum of internal and external forces [N].
struct ForceNorms {
  double unbalanced = 0;  ///< at free unknowns
  double support = 0;     ///< at fixed unknowns
};

/// Nodes are stored in a box of rows, in separate arrays of the components of displacement and velocity.  The forces on
/// a row are complete when the next row is reached and are applied at once.  Every spring is computed once.
class LatticeMotion {
 public:
  /// Whether there is a kernel for the model: a cubic lattice, whole or with cells missing, of springs with or without
  /// volume and hourglass correction or momentum dispersion; or of averaged springs in full cells.
  /// Viscosity: of cells; there is none along springs.  A share of consistent mass: of boxes of full cells, undamped or
  /// damped in proportion to their mass.
  static bool suits(const MassSpringModel& model, const Viscosity& viscosity = {}, double mass_consistency = 0);
  /// The same for a GPU: without momentum dispersion, viscosity and shares of consistent mass.
  static bool suits_gpu(const MassSpringModel& model, const LatticeMotionOptions& options);

  /// At rest at X, nothing fixed, no load.  Keeps a reference to the network.
  /// @throws std::invalid_argument unless suits() the options, or for an instruction set that is not usable here.
  LatticeMotion(const MassSpringModel& model, double density, const LatticeMotionOptions& options = {});
  LatticeMotion(LatticeMotion&&) noexcept;
  LatticeMotion& operator=(LatticeMotion&&) noexcept;
  ~LatticeMotion();

  /// Sets supports and external forces for the following steps; fixed unknowns are moved at the end of the first of
  /// them.
  void set_conditions(const BoundaryConditions& conditions);
  /// Moves the fixed unknowns at once.
  void move_supports();

  /// [m], [m/s]; all velocities here are momenta over lumped masses if these are averaged.
  void set_state(const NodalVectors& x, const NodalVectors& v);

  /// Displacement [m], then velocity [m/s] of nodes begin <= n < end, six values per node.
  void read(int begin, int end, double* values) const;
  void write(int begin, int end, const double* values);

  /// Steps v = (v + dt f/m) / (1 + damping dt), x += dt v, or dt times the velocities of MassAverage.
  /// @return the norms at the beginning of the last step.
  ForceNorms advance(long steps, double time_step, double damping);

  NodalVectors positions() const;   ///< [m]
  NodalVectors velocities() const;  ///< [m/s]
  NodalVectors forces();            ///< internal forces [N]

  double bytes_per_node() const;    ///< of all stored arrays
  std::string description() const;  ///< which kernel runs

 private:
  class Arrays;
  template <class Real>
  class ArraysOf;
  template <class Real>
  class ArraysOnGpu;
  std::unique_ptr<Arrays> arrays_;
};

}  // namespace springproof
