// A body of whole cubes under its true surface, and the models of it that move beside each other in the live page.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "meshes/surface/surface.h"
#include "msm/dynamics/lattice_motion.h"
#include "problem/material.h"

namespace springproof {

/// What a facet of the surface is for.
enum class LivePart : unsigned char { free, held, pulled };

/// A point of the surface by the corners of a cube; weights sum to 1, a point outside is continued.
struct LivePoint {
  int cell;
  std::array<double, 8> weights;
};

struct LiveBody {
  Surface surface;              ///< [m]
  std::vector<LivePart> parts;  ///< per facet
  Mesh mesh;                    ///< the cubes, patches "held" and "pulled" (if any facet is)
  std::vector<LivePoint> places;
  std::vector<int> held;           ///< nodes of the mesh
  Eigen::VectorXd pull;            ///< share of each node in a force on the pulled facets; zero if there are none
  std::vector<std::string> notes;  ///< what was left out, for the user
};

/// Cuts a surface into about `cells` cubes whose centres lie inside.  Holes are closed by a cone to its middle.
/// @throws InputError if an edge belongs to three facets, or the cubes fall apart.
LiveBody live_body(Surface surface, std::vector<LivePart> parts, double cells);

/// The surface of an STL file: welded, brought to a height of 0.25 m with its lowest point at z = 0, held where it
/// stands (facets in its lowest fiftieth; if none, below the lowest cubes), nothing pulled.
/// @throws InputError as parse_stl() and live_body(), or if the body is flat.
LiveBody live_stl(std::string_view bytes, double cells);

/// A pull by the pointer: a spring between the mean of the nodes near a point and a target.
struct LiveGrip {
  std::vector<int> nodes;
  std::vector<double> weights;  ///< they sum to 1
  Vec3 offset = Vec3::Zero();   ///< of the target from that mean when nothing is pulled [m]
};

/// Which numbers keep positions within 1e-6 m of those of 64 bits: cells without an energy of volume can be folded by a
/// pull, and a folded body amplifies round-off a hundredfold.
/// @throws InputError for a model that is not made of the mesh's cells.
Precision sufficient_precision(const std::string& name);

/// One model of a body in motion; what happens to it, it stays finite.
class LiveModel {
 public:
  /// At rest.  Keeps a reference to the body.
  /// @throws InputError for a model that is not made of the mesh's cells.
  LiveModel(const LiveBody& body, const std::string& name, const IsotropicMaterial& material, Precision precision);

  /// Other constants, the same motion.
  void set_material(const IsotropicMaterial& material);
  void rest();  ///< back to rest at X

  void grab(int point);  ///< of the surface, where it is now; -1: let go
  void pull_to(const Vec3& target);
  void load(const Vec3& force);  ///< on the pulled facets [N]

  /// Steps for so long [s], velocities decaying by `damping` [1/s].  @return the number of steps.
  int advance(double duration, double damping);

  double time_step() const;  ///< that advance() would take now [s]
  double volume_change() const { return volume_change_; }
  double least_volume() const { return least_volume_; }      ///< smallest V'/V of a cell
  double kinetic_energy() const { return kinetic_energy_; }  ///< [J]
  double unbalanced() const { return unbalanced_; }          ///< norm of the forces on free nodes [N]
  double frequency() const {
    return frequency_;
  }                                          ///< of the motion that the load would make, by its static shape [1/s]
  Vec3 pulling() const { return pulling_; }  ///< force of the grip [N]
  int rescues() const { return rescues_; }   ///< how often an unstable state was taken back
  const NodalVectors& positions() const { return x_; }
  const std::vector<float>& surface_positions() const { return points_; }       ///< x y z per point [m]
  const std::vector<float>& surface_dilatation() const { return dilatation_; }  ///< V'/V - 1 about each point

 private:
  void build(const IsotropicMaterial& material);
  void set_conditions();
  void kick(double duration);
  bool measure();  ///< false: unstable
  double shrink() const;

  const LiveBody& body_;
  std::string name_;
  Precision precision_;
  IsotropicMaterial material_;
  MassSpringModel model_;
  std::unique_ptr<LatticeMotion> motion_;
  Eigen::VectorXd mass_;
  double safe_step_ = 0, grip_stiffness_ = 0, grip_limit_ = 0, caution_ = 1;
  LiveGrip grip_;
  Vec3 target_ = Vec3::Zero(), force_ = Vec3::Zero(), pulling_ = Vec3::Zero();
  NodalVectors x_, v_;
  std::vector<float> points_, dilatation_;
  double volume_change_ = 0, least_volume_ = 1, least_stretch_ = 1, largest_area_ = 1, kinetic_energy_ = 0,
         unbalanced_ = 0, frequency_ = 0;
  int rescues_ = 0;
};

}  // namespace springproof
