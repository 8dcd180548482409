// A model in motion, step by step: what every integrator and every kernel implements, and what they are told.
#pragma once

#include <optional>
#include <string>

#include "msm/dynamics/terms/relaxing_cells.h"
#include "msm/dynamics/terms/viscosity.h"
#include "msm/embedding/boundary.h"
#include "msm/kernels/instruction_set.h"

namespace springproof {

class PlaneContact;

enum class Integrator {
  explicit_euler,   ///< semi-implicit Euler: order 1 in the energy, 2 in the positions; a bounded step
  energy_momentum,  ///< midpoint kinematics with the forces of EnergyMomentum: order 2, undamped
  implicit_euler,   ///< order 1, damps strongly
};

/// Name of an integrator, for people.
/// @param integrator any
/// @return "energy-momentum"
const char* name_of(Integrator integrator);

enum class Precision { float64, float32 };

/// Where steps are made.  A GPU: the one that the library was built for (SPRINGPROOF_CUDA); in a library without one
/// its code runs on the processor, thread by thread, which is slow.
enum class Device { processor, gpu };

/// How the steps of a motion are made.  What an implementation lacks of it, its suits() or check_step() refuses.
struct MotionOptions {
  Integrator integrator = Integrator::explicit_euler;  ///< explicit, or one that takes large steps
  std::optional<double> time_step = {};                ///< [s]; empty: checked_time_step() has a default, a Motion none
  double damping = 0;        ///< mass-proportional, force -damping * m * v [1/s]; non-conservative momentum dispersion
                             ///< needs some, or it flutters
  Viscosity viscosity = {};  ///< by kernels that of cells
  RelaxingCells relaxation = {};    ///< branches of cells, relaxed at the start
  bool branch_energies = false;     ///< Motion::branch_energies() is asked for
  double mass_consistency = 0;      ///< share of consistent mass of explicit steps, 0 to 1: MassAverage.  With it every
                                    ///< velocity v of a step, of Motion too, is the momentum over the lumped mass
  bool lagged = false;              ///< dispersion uses the J of the previous step; Kot & Nagahashi (2015), sec. 7
  PlaneContact* contact = nullptr;  ///< a plane that the body may fall on; large steps end on it, and run_dynamics()
                                    ///< lets explicit steps do so; nullptr: there is none
  Precision precision = Precision::float64;  ///< of the kernels, float32: forces to 1e-6 of the largest, twice as fast;
                                             ///< others use float64
  int threads = 1;                           ///< of the kernels; momentum dispersion uses one
  InstructionSet instructions = instruction_set();
  Device device = Device::processor;  ///< of lattices
};

/// Norms of the sum of internal and external forces [N].
struct ForceNorms {
  double unbalanced = 0;  ///< at free unknowns
  double support = 0;     ///< at fixed unknowns
};

/// Of branches that relax [J].
struct BranchEnergies {
  double stored = 0, dissipated = 0;  ///< now; since they were relaxed
};

/// A model in motion, made at rest at X, nothing fixed, no load.  It keeps a reference to the model.
class Motion {
 public:
  virtual ~Motion() = default;
  /// Sets supports and loads of the following steps; fixed unknowns are moved at the end of the first of them.
  /// @param conditions supports and loads
  virtual void set_conditions(const BoundaryConditions& conditions) = 0;
  /// Moves the supports to their places immediately.
  virtual void move_supports() = 0;
  /// Sets the state.
  /// @param x positions [m], n x 3
  /// @param v velocities [m/s], n x 3
  virtual void set_state(const NodalVectors& x, const NodalVectors& v) = 0;
  /// Relaxes all branches (MotionOptions::relaxation) in the present state.
  virtual void relax() {}
  /// @return forces of the branches [N], n x 3; empty: there are none
  virtual NodalVectors relaxing_forces() const { return {}; }
  /// With MotionOptions::branch_energies.
  /// @return at the positions; dissipated exactly, but by kernels as a straight power over each call of advance() has
  ///   it, of second order in its length; empty: there are no branches
  virtual std::optional<BranchEnergies> branch_energies() const { return {}; }
  /// Makes steps.
  /// @param steps how many
  /// @return the norms of forces at the beginning of the last step
  virtual ForceNorms advance(long steps) = 0;
  /// @return positions [m], n x 3
  virtual NodalVectors positions() const = 0;
  /// @return velocities [m/s], n x 3
  virtual NodalVectors velocities() const = 0;
  /// @return the integrator and kernel in words
  virtual std::string description() const = 0;
  /// @return why the last advance() has no result; empty: it has one
  virtual std::string failure() const { return ""; }
};

/// A motion whose state is that of the nodes in their order.
class MotionOfNodes : public Motion {
 public:
  void move_supports() override;
  void set_state(const NodalVectors& x, const NodalVectors& v) override;
  void relax() override { overstrains_.relax(x_); }
  NodalVectors positions() const override { return x_; }
  NodalVectors velocities() const override { return v_; }

 protected:
  MotionOfNodes(const MassSpringModel& model, const MotionOptions& options);

  const MassSpringModel& model_;
  BoundaryConditions conditions_;
  Overstrains overstrains_;
  NodalVectors x_, v_;
};

}  // namespace springproof
