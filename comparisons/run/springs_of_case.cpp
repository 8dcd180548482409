#include "comparisons/run/springs_of_case.h"

#include "comparisons/run/input_checksum.h"
#include "msm/measure/moduli.h"
#include "msm/models.h"
#include "msm/springs_of_model.h"

namespace springproof {
namespace {

EmbeddedSurface carried_surface(const PreparedCase& prepared, const EmbeddedModel& built) {
  const Mesh& cells = *prepared.lattices.front().mesh;
  return carried_surface(prepared.tetrahedra.empty() ? cells : *prepared.tetrahedra.back(), cells, built.model.network,
                         built.embedding);
}

std::map<std::string, double> derived_of(const SpringsFile& file, const ModelParameters& parameters) {
  std::map<std::string, double> derived = springproof::derived_of(file);
  if (!parameters.springs) {
    const MeasuredModuli m = measure_moduli(parameters, *file.material);
    derived.merge(std::map<std::string, double>{{"measured_youngs_modulus_Pa", m.youngs_modulus},
                                                {"measured_poisson_ratio", m.poisson_ratio},
                                                {"measured_shear_modulus_Pa", m.shear_modulus}});
  }
  return derived;
}

}  // namespace

SpringsFile springs_of(const PreparedCase& prepared) {
  const Lattice& lattice = prepared.lattices.front();
  const ModelParameters& parameters = prepared.models.front();
  const IsotropicMaterial& material = prepared.experiment.materials.front();
  const ModelChoice& choice = prepared.experiment.models.front();
  if (parameters.cut.value_or(false))
    throw InputError(choice.where, "compare.models: cut = true: springs files hold whole cubes (allowed: cut = false)");
  EmbeddedModel built = build_embedded(parameters, *lattice.mesh, material, lattice.region.get());
  SpringsFile file;
  file.density = material.density;
  file.material = material;
  file.grip = parameters.springs ? parameters.springs->grip : grip_of(parameters, *lattice.mesh);
  file.grip_from_cells =
      parameters.springs ? parameters.springs->grip_from_cells : parameters.row.topology != Topology::random;
  file.patches = built.embedding.held;
  file.surface = carried_surface(prepared, built);
  file.model = std::move(built.model);
  file.origin = {"springproof " SPRINGPROOF_VERSION, choice.name, choice.options,
                 prepared.experiment.text.empty() ? prepared.geo.filename().string()
                                                  : prepared.experiment.file.filename().string(),
                 input_checksum(prepared)};
  file.derived = derived_of(file, parameters);
  return file;
}

}  // namespace springproof
