// What CalculiX and our finite elements are both asked, and what each says.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "comparisons/calculix/cross_check.h"
#include "comparisons/calculix/deck.h"
#include "comparisons/judge/reference_value.h"
#include "comparisons/prepare/prepared_case.h"
#include "comparisons/results/records.h"
#include "comparisons/sweep/status.h"

namespace springproof {

/// Whether both programs are asked for the motion of a case instead of its equilibrium.
inline bool moves_in_time(const Experiment& experiment) { return experiment.dynamics && experiment.reference.in_time; }

/// One case at one Poisson's ratio, to be solved by both programs: a body of voxels by both on its three meshes of
/// tetrahedra.
struct Question {
  const PreparedCase& prepared;
  IsotropicMaterial material;
  int modes;                                        ///< 0: its equilibrium or motion
  std::vector<std::string> grids;                   ///< CalculiX', coarse to fine, in words
  std::vector<std::shared_ptr<const Mesh>> meshes;  ///< the same
  NodalVectors points;                              ///< where the displacements of both are compared [m]
  Eigen::VectorXd weights;                          ///< of these points [m^3]
  double time_limit;

  const Experiment& experiment() const { return prepared.experiment; }
  bool moves() const { return modes == 0 && moves_in_time(experiment()); }
  bool same_meshes() const { return experiment().body.is_voxels(); }
  /// Ours has no pressures, and both integrate exactly: they solve the same equations.
  bool same_equations() const {
    return same_meshes() && modes == 0 && !moves() && experiment().kinematics == "linear" &&
           !calculix::needs_reduced_integration(experiment(), material);
  }
};

/// Values extrapolated from the three grids.
struct Opinion {
  std::map<std::string, ReferenceValue> values;
  ReferenceField field;
  NodalVectors finest;     ///< on the finest grid, at Question::points [m]
  double noise = 0;        ///< of each of its components [m]
  HistoryRecord history;   ///< of a motion: the displacements of the probes
  double uncertainty = 0;  ///< of these, relative to their norm over time
};

/// The hexahedra of a case, with its regions and patches.
Mesh mesh_of_cells(const Experiment& experiment, const std::filesystem::path& geo, const Cells& cells);

/// @param prepared kept by reference
/// @throws InputError for grids that cannot be halved twice, and for frequencies that cannot be compared
Question question(const PreparedCase& prepared, const IsotropicMaterial& material, const CrossCheckOptions& options);

/// What CalculiX says; nothing where it has no answer, which `status` tells.
std::optional<Opinion> ask_calculix(const Question& q, Status& status);

/// What our finite elements say.
std::optional<Opinion> ask_fem(const Question& q, Status& status);

}  // namespace springproof
