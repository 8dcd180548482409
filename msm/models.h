// THE table of models: name -> topology + pattern + laws.  A new model is a new row.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "msm/laws/laws.h"
#include "problem/experiment.h"

namespace springproof {

/// Where the nodes are and which of them are joined.
enum class Topology {
  cells,      ///< cubic lattice by superposition of cells: nodes are the corners of the mesh's cubes
};

/// What gives the springs, whose own Poisson's ratio is 1/4 (in the plane 1/3), another one.
enum class Extension { none, volume_correction, momentum_dispersion };

/// Which modulus the springs reproduce when their own Poisson's ratio (1/4) is not the material's.
enum class Calibration {
  shear_modulus,   ///< G = E / (2 (1 + nu)): what an extension needs
  youngs_modulus,  ///< E, as if nu were 1/4 (G = 2 E / 5): how a classic mass-spring model is set up
};

struct ModelRow {
  std::string name;
  std::string what;            ///< one line for --help and the report
  Topology topology;
  double face_to_cube;         ///< default A = k_f / k_c
  bool any_face_to_cube;       ///< A may be chosen
  Extension extension;
  bool bending_correction;
  bool torsion_correction;
  Calibration calibration;
};

const std::vector<ModelRow>& model_table();

/// A model choice with every option settled.
struct ModelParameters {
  ModelRow row;
  double face_to_cube = 2;
  bool paper_e_form = false;                          ///< springs from E by Golec et al. (2019), (5.12) right, as in its tables
  VolumeEnergy volume_energy = VolumeEnergy::bounded;
  Dispersion dispersion = Dispersion::symmetric;
  bool volume_weights = true;                         ///< exact nodal volumes (msm/dispersion_weights.h); false: w = k L

  bool has(Extension extension) const { return row.extension == extension; }
};

/// @throws InputError (with the place in the case file) for an unknown model or option, the nearest name suggested.
ModelParameters resolve(const ModelChoice& choice);

/// The model of a body.  @throws InputError if the mesh does not suit it.
MassSpringModel build_model(const ModelParameters& parameters, const Mesh& mesh, const IsotropicMaterial& material);

/// Shear modulus [Pa] that the springs of this model are calibrated to.
double spring_shear_modulus(const ModelParameters& parameters, const IsotropicMaterial& material);

}  // namespace springproof
