// What is recorded of the motion of one network: its history, and the frames of an animation.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "comparisons/prepare/prepared_case.h"
#include "comparisons/results/records.h"
#include "msm/dynamics/dynamics.h"
#include "msm/dynamics/terms/mass_average.h"
#include "msm/models.h"

namespace springproof {

/// The network of a case that moves.
struct MovingNetwork {
  const PreparedCase& prepared;
  const Lattice& lattice;
  const EmbeddedModel& built;
  const IsotropicMaterial& material;

  const Network& network() const { return built.model.network; }
  const MotionChoice& motion() const { return *prepared.experiment.dynamics; }
  Eigen::VectorXd masses() const { return springproof::masses(network(), material.density); }  ///< [kg]
};

/// What is recorded of a motion.
struct MotionRecord {
  HistoryRecord history;
  std::vector<std::pair<double, NodalVectors>> frames;  ///< time [s] and displacement of the lattice's mesh [m]
};

/// Records the motion of one network, sample by sample.
class MotionRecorder {
 public:
  /// Keeps references to all but the options.
  MotionRecorder(const MovingNetwork& moving, const MotionOptions& options, MotionRecord& record);

  void operator()(const MotionSample& now);

 private:
  NodalVectors at_positions(const MotionSample& now) const;
  NodalVectors forces_beside(const MotionSample& now, const NodalVectors& v) const;
  Field field_at(const MotionSample& now, const NodalVectors& v) const;
  void add_momenta(const NodalVectors& x, const NodalVectors& s);
  void add_probes(const NodalVectors& u, const Field& field);
  void add(const std::string& name, const char* unit, double value);
  void add_vector(const std::string& name, const char* unit, const Vec3& v);
  void add_impulse(const ContactImpulse& further);

  MovingNetwork moving_;
  Eigen::VectorXd mass_;
  NodalVectors per_mass_;  ///< of masses and support masses
  double behind_;          ///< the velocities of a step [s]
  double damping_;         ///< [1/s]
  Viscosity viscosity_;
  MassAverage average_;
  PlaneContact* contact_;   ///< nullptr: there is no plane
  ContactImpulse impulse_;  ///< of the plane on the body so far
  bool cut_;                ///< the network is of cut cells of the lattice
  MotionRecord& record_;
  std::size_t next_ = 0;  ///< quantity
};

}  // namespace springproof
