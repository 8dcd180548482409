// THE table of models: name -> topology + pattern + laws.  A new model is a new row.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "msm/laws/capabilities.h"
#include "msm/topology/random/random_network.h"
#include "problem/material.h"
#include "problem/model_choice.h"

namespace springproof {

struct SpringsFile;

/// Positions of the nodes and which of them are connected.
enum class Topology {
  cells,      ///< cubic lattice by superposition of cells: nodes are the corners of the mesh's cubes
  centres,    ///< cubic lattice with a node in the middle of each cube
  random,     ///< random sequential addition, one node per cube of the mesh on average
  hexagonal,  ///< triangles in the plane z = const, for plane strain
  file,       ///< those of a springs file
};

/// Extension that gives the springs, whose own Poisson's ratio is 1/4, another one.
enum class Extension {
  none,
  volume_correction,
  momentum_dispersion,
  angular_springs,
  averaging,  ///< springs averaged over each cell, with a volume term of their own (msm/laws/averaged_springs.h)
};

/// Which modulus the springs reproduce when their own Poisson's ratio (1/4) is not the material's.
enum class Calibration {
  shear_modulus,   ///< G = E / (2 (1 + nu)): required by an extension
  youngs_modulus,  ///< E, as if nu were 1/4 (G = 2 E / 5): as in a classic mass-spring model
  patch_test,  ///< G, spring by spring: every affine strain is in equilibrium at every node (parameters/patch_fit.h)
};

/// A row of the table.
struct ModelRow {
  std::string name;         ///< "hybmss_avg"
  std::string what;         ///< one line for --help and the report
  Topology topology;        ///< nodes and connections
  double face_to_cube;      ///< default A = k_f / k_c, of cubic lattices
  bool any_face_to_cube;    ///< A may be chosen
  Extension extension;      ///< what gives another Poisson's ratio than 1/4
  bool bending_correction;  ///< hourglass modes of bending have the stiffness of the solid
  bool torsion_correction;  ///< those of torsion too
  Calibration calibration;  ///< of the springs
};

/// All models.
/// @return the rows, in the order of `springproof list`
const std::vector<ModelRow>& model_table();

/// The row that the table recommends for any solid.
const ModelRow& recommended_model();

/// The only Poisson's ratio that a model can have: springs without an extension are solids of nu = 1/4.
/// @param row of the table
/// @return 1/4; empty: any (of a springs file: not known)
std::optional<double> own_poisson_ratio(const ModelRow& row);

/// Whether each law of a model can, whatever its parameters: Capability::large_displacements, that solve_finite() and
/// run_dynamics() may take it; Capability::cells_of_any_shape, that its cells may be boxes.
/// @param row of the table
/// @param what is asked of its laws
/// @return true: all can
bool can(const ModelRow& row, Capability what);

/// Whether springs between nodes are all that the model has.
/// @param row of the table
/// @return true: its forces are those of springs
inline bool of_springs_alone(const ModelRow& row) {
  return row.extension == Extension::none && !row.bending_correction;
}

/// Whether each spring has its own constant, by the patch test at its nodes.
/// @param row of the table
/// @return true for emsm_patch
inline bool passes_patch_test(const ModelRow& row) { return row.calibration == Calibration::patch_test; }

/// A model choice with all options resolved.
struct ModelParameters {
  ModelRow row;               ///< its row
  double face_to_cube = 2;    ///< A = k_f / k_c
  bool paper_e_form = false;  ///< springs from E by Golec et al. (2019), (5.12) right, as in its tables
  VolumeEnergy volume_energy = VolumeEnergy::bounded;  ///< of the volume correction
  Dispersion dispersion = Dispersion::symmetric;       ///< form of momentum dispersion
  std::optional<bool> exact_volumes;  ///< dispersion weights: exact nodal volumes (msm/cells/dispersion_weights.h) or w
                                      ///< = k L; empty: exact where q >= 0
  bool homogenised = true;            ///< random networks: calibrated by homogenisation in bulk; false: by eq. (20)
  RandomParameters random{};          ///< of random networks; its spacing follows from the mesh
  std::optional<double> node_density;  ///< of random networks [1/m^3]; empty: one node per cube
  std::optional<double> grip;          ///< depth in node spacings to which supports hold nodes that are not the mesh's
  double turned = 0;                   ///< of node-centred lattices: angle about z [rad] between lattice and axes
  bool hold_rigid_motions = false;     ///< constrains those that the loads leave free, instead of an error
  std::optional<bool> cut;             ///< of cut cells instead of whole cubes; empty: as the body says
  std::optional<bool> coarsened;       ///< cut cells measured in finer ones (msm/coarsening/); empty: as the body says
  double shift = 0;                    ///< AveragedSprings::shift
  std::optional<StrainCurve> curve;    ///< of averaged springs; empty: Hencky's, in a case that of its material law
  bool slender = false;                ///< torsional stiffness of cells of which a body has two and more across
  int seeds = 1;                       ///< number of random networks to average: random.seed and those after it
  std::shared_ptr<const SpringsFile> springs = {};  ///< of Topology::file: network, laws and material as read

  /// Whether the model has this extension.
  /// @param extension which
  /// @return true: it has
  bool has(Extension extension) const { return row.extension == extension; }
};

/// Looks up a model and sets its options.
/// @param choice name of a row, or springs file, and options: `resolve({"hybmss_avg", {}, "", {}})`
/// @return the row with all options set, those not given to their defaults
/// @throws InputError (with the place in the case file) for an unknown model or option, the nearest name suggested.
ModelParameters resolve(const ModelChoice& choice);

/// Shear modulus that the springs of this model are calibrated to.
/// @param parameters of the model
/// @param material of the body
/// @return [Pa]; of models that can only have nu = 1/4 that of the same E
double spring_shear_modulus(const ModelParameters& parameters, const IsotropicMaterial& material);

}  // namespace springproof
