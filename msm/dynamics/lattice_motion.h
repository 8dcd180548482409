// Explicit dynamics of a lattice: the same forces and the same method as the plain loops of run_dynamics(), several
// times as fast.
#pragma once

#include <memory>
#include <string>

#include "msm/embedding/boundary.h"
#include "msm/kernels/instruction_set.h"
#include "msm/laws/laws.h"

namespace springproof {

enum class Precision { float64, float32 };

struct LatticeMotionOptions {
  Precision precision = Precision::float64;  ///< float32: forces to 1e-6 of the largest, twice as fast
  int threads = 1;                           ///< at most one per plane of nodes; momentum dispersion has one
  InstructionSet instructions = instruction_set();
};

/// Norms of internal and external forces together [N].
struct ForceNorms {
  double unbalanced = 0;  ///< at free unknowns
  double support = 0;     ///< at fixed unknowns
};

/// Nodes lie in a box of rows, in separate arrays of the components of displacement and velocity; forces of a row are
/// complete when the next one is reached, and are then spent at once.  Every spring is computed once.
class LatticeMotion {
 public:
  /// Whether there is a kernel for the model: a cubic lattice, whole or with cells missing, of springs with or without
  /// volume and hourglass correction or momentum dispersion.
  static bool suits(const MassSpringModel& model);

  /// At rest at X, nothing fixed, no load.  Keeps a reference to the network.
  /// @throws std::invalid_argument unless suits(model), or for an instruction set that is not usable here.
  LatticeMotion(const MassSpringModel& model, double density, const LatticeMotionOptions& options = {});
  LatticeMotion(LatticeMotion&&) noexcept;
  LatticeMotion& operator=(LatticeMotion&&) noexcept;
  ~LatticeMotion();

  /// Supports and external forces of the steps to come; fixed unknowns are moved at the end of the first of them.
  void set_conditions(const BoundaryConditions& conditions);
  /// Moves the fixed unknowns at once.
  void move_supports();

  void set_state(const NodalVectors& x, const NodalVectors& v);  ///< [m], [m/s]

  /// Of nodes begin <= n < end: displacement [m], then velocity [m/s], six values each.
  void read(int begin, int end, double* values) const;
  void write(int begin, int end, const double* values);

  /// Steps v = (v + dt f/m) / (1 + damping dt), x += dt v.
  /// @return the norms at the beginning of the last step.
  ForceNorms advance(long steps, double time_step, double damping);

  NodalVectors positions() const;   ///< [m]
  NodalVectors velocities() const;  ///< [m/s]
  NodalVectors forces();            ///< internal forces [N]

  double bytes_per_node() const;    ///< of what is kept
  std::string description() const;  ///< which kernel runs

 private:
  class Arrays;
  template <class Real>
  class ArraysOf;
  std::unique_ptr<Arrays> arrays_;
};

}  // namespace springproof
