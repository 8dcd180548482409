#include "msm/statics/mixed_form.h"

#include "msm/laws/capabilities.h"
#include "msm/multigrid/cut/cut_mixed_multigrid.h"
#include "msm/multigrid/cut/cut_multigrid.h"
#include "msm/multigrid/dispersion_multigrid.h"
#include "msm/parameters/calibrate.h"

namespace springproof {
namespace {

constexpr double mixed_above_kappa = 4;            // kappa / G: 3 at nu = 0.4, 8 at 0.45
constexpr double cut_cells_mixed_above_kappa = 6;  // the same of cut cells

}  // namespace

bool on_lattice(const MassSpringModel& model) {
  return can(model, Capability::equal_cells) || can(model, Capability::nodal_pressures) ||
         can(model, Capability::cut_multigrid);
}

bool mixed_form_pays(const MassSpringModel& model) {
  return on_lattice(model) &&
         volume_stiffness_ratio(model) >
             (can(model, Capability::cut_multigrid) ? cut_cells_mixed_above_kappa : mixed_above_kappa);
}

std::unique_ptr<SaddlePoint> saddle_point_at_rest(const MassSpringModel& model, const std::vector<char>& fixed) {
  const double G = affine_shear_modulus(model);
  if (can(model, Capability::cut_multigrid)) return std::make_unique<CutMixedMultigrid>(model, fixed);
  if (dispersion_of(model)) return std::make_unique<DispersionMultigrid>(model, fixed, G);
  return std::make_unique<MixedMultigrid>(lattice_levels(model.network, fixed),
                                          in_units(cell_stiffness(model), G, model.network.cells.edge));
}

}  // namespace springproof
