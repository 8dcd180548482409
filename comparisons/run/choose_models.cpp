#include "comparisons/run/choose_models.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "comparisons/models/external.h"
#include "comparisons/prepare/load_resultants.h"
#include "meshes/volume.h"
#include "msm/dynamics/terms/relaxing_cells.h"
#include "msm/exchange/springs_file.h"
#include "msm/laws/capabilities.h"
#include "msm/models.h"

namespace springproof {
namespace {

[[noreturn]] void refuse_model(const Experiment& e, std::size_t number, const std::string& why) {
  throw InputError(e.models[number].where, "compare.models: " + why);
}

/// Whether they relax alike, to the digits of a file.
bool same(const RelaxingCells& a, const RelaxingCells& b) {
  const auto equal = [](double x, double y) { return std::abs(x - y) <= 1e-9 * std::max(std::abs(x), std::abs(y)); };
  const auto &p = a.relaxation.branches, &q = b.relaxation.branches;
  const HourglassStiffness &h = a.cells.hourglass, &k = b.cells.hourglass;
  return std::ranges::equal(
             p, q, [&](const auto& x, const auto& y) { return equal(x.share, y.share) && equal(x.time, y.time); }) &&
         equal(a.cells.shear_modulus, b.cells.shear_modulus) && equal(h.bending, k.bending) &&
         equal(h.coupling, k.coupling) && equal(h.torsion, k.torsion) && equal(h.twist, k.twist) &&
         equal(h.warping, k.warping);
}

/// @throws InputError at a springs file that relaxes otherwise than the case's material.
void check_relaxing(const PreparedCase& prepared, std::size_t m, const IsotropicMaterial& material) {
  if (!prepared.models[m].springs) return;
  const SpringsFile& file = *prepared.models[m].springs;
  const Experiment& e = prepared.experiment;
  const auto refuse = [&](const std::string& why) { refuse_model(e, m, e.models[m].label + ": " + why); };
  if (file.relaxing.acts() && !e.relaxation.acts())
    refuse("/relaxation: the springs of the file relax (needed: its branches as [material.relaxation])");
  if (!file.relaxing.acts() && e.relaxation.acts())
    refuse("the springs of the file do not relax (allowed: a file with branches; or no [material.relaxation])");
  if (std::isfinite(e.loaded_for))
    refuse("the springs of a file have their long-time moduli at rest (allowed: no equilibrium_after_s)");
  if (!same(file.relaxing, RelaxingCells::of(file.model, material, e.relaxation)))
    refuse("/relaxation: is not that of the case's [material.relaxation] (needed: the same branches and constants)");
}

/// "core (E = 10000 Pa, nu = 0.3, 1000 kg/m^3)", one after the other.
std::string words_of(const std::vector<SpringsRegion>& regions) {
  std::vector<std::string> words;
  for (const auto& [name, m] : regions)
    words.push_back(
        fmt::format("{} (E = {:g} Pa, nu = {:g}, {:g} kg/m^3)", name, m.youngs_modulus, m.poisson_ratio, m.density));
  return words.empty() ? "none" : fmt::format("{}", fmt::join(words, ", "));
}

/// @throws InputError at a springs file whose regions are not the case's.
void require_regions(const ModelParameters& p, const Experiment& e) {
  if (!p.springs) return;
  std::vector<SpringsRegion> wanted;
  for (const MaterialRegion& r : e.regions) wanted.push_back({r.name, r.material});
  const auto equal = [](double a, double b) { return std::abs(a - b) <= 1e-9 * std::abs(b); };
  const bool same = std::ranges::equal(p.springs->regions, wanted, [&](const auto& a, const auto& b) {
    return a.name == b.name && equal(a.material.youngs_modulus, b.material.youngs_modulus) &&
           same_poisson_ratio(a.material.poisson_ratio, b.material.poisson_ratio) &&
           equal(a.material.density, b.material.density);
  });
  if (!same || e.listed.materials.size() > 1)
    throw InputError(fmt::format("{}: /regions: {} (allowed: the [[region]]s of the case, {}{})", p.row.name,
                                 words_of(p.springs->regions), words_of(wanted),
                                 e.listed.materials.size() > 1 ? ", of one material each" : ""));
}

/// @throws InputError at a springs file that stands for other materials than the case's.
void check_own_models(const PreparedCase& prepared) {
  const Experiment& e = prepared.experiment;
  for (std::size_t m = 0; m < prepared.models.size(); ++m)
    for (const IsotropicMaterial& material : e.materials) try {
        require_material(prepared.models[m], material);
        require_regions(prepared.models[m], e);
      } catch (const InputError& error) {
        refuse_model(e, m, error.what());
      }
  for (std::size_t m = 0; m < prepared.models.size(); ++m)
    for (const IsotropicMaterial& material : e.materials) check_relaxing(prepared, m, material);
}

/// Decides which models take cut cells.
/// @throws InputError for a model that is to and cannot.
void choose_cut_cells(PreparedCase& prepared) {
  const Experiment& e = prepared.experiment;
  for (std::size_t m = 0; m < prepared.models.size(); ++m) {
    ModelParameters& p = prepared.models[m];
    const bool averaged = p.has(Extension::averaging), large = e.model_kinematics() != Kinematics::linear;
    const char* reason = !has_cut_cells(p.row)                ? "this model has none"
                         : !e.body.is_voxels()                ? "the body is a block"
                         : e.fracture                         ? "the body breaks"
                         : e.models[m].in_motion && !averaged ? "it is to move in time"
                         : large && !averaged                 ? "the displacements are large"
                                                              : nullptr;
    if (reason && p.cut.value_or(false))
      refuse_model(
          e, m,
          fmt::format("{}: cut = true: {} (allowed: lattices of cells in a body of voxels, at rest under small "
                      "displacements; hybmss_avg also under large ones and in motion)",
                      p.row.name, reason));
    p.cut = p.cut.value_or(e.body.cut && !reason);
  }
  if (e.body.accuracies.empty()) return;
  const auto is_cut = [](const ModelParameters& p) { return *p.cut; };
  if (e.fracture || std::ranges::none_of(prepared.models, is_cut))
    throw InputError(
        e.body.where,
        "body.accuracy: cells of several sizes are for models of cut cells (allowed: no [fracture], and one such "
        "model)");
  if (flies(e))
    throw InputError(e.body.where,
                     "body.accuracy: cells are halved where the loads strain the body at rest, and nothing holds this "
                     "one (allowed: a load with displacement_m; or voxels, or voxel_edge_m, alone)");
}

/// Decides which models take cells that are measured.
/// @throws InputError for a model that is to and cannot.
void choose_measured_cells(PreparedCase& prepared) {
  const Experiment& e = prepared.experiment;
  std::string reasons;
  for (std::size_t m = 0; m < prepared.models.size(); ++m) {
    ModelParameters& p = prepared.models[m];
    const char* reason = !*p.cut                      ? "its cells are not cut"
                         : !e.body.accuracies.empty() ? "accuracy makes cells of several sizes"
                         : p.shift > 0                ? "shift is for averaged springs"
                         : p.curve.value_or(StrainCurve::hencky) != StrainCurve::hencky
                             ? "at large strain they follow Hencky's law"
                             : nullptr;
    if (reason && p.coarsened.value_or(false))
      refuse_model(e, m, fmt::format("{}: coarsened = true: {} (allowed: cut cells of one size)", p.row.name, reason));
    p.coarsened = p.coarsened.value_or(e.body.coarsened && !reason);
    if (reason) reasons += fmt::format("{}{}: {}", reasons.empty() ? "" : "; ", p.row.name, reason);
  }
  const auto is_measured = [](const ModelParameters& p) { return *p.coarsened; };
  if (e.body.coarsened && std::ranges::none_of(prepared.models, is_measured))
    throw InputError(e.body.where,
                     fmt::format("body.coarsened: no model of the case has cells that can be measured ({}; "
                                 "allowed: one of cut cells)",
                                 reasons.empty() ? "there is none" : reasons));
}

/// @throws InputError at options of nodes at random, for a network whose nodes are the vertices of a mesh.
void check_vertex_options(const PreparedCase& prepared) {
  if (!prepared.experiment.body.is_voxels()) return;
  for (std::size_t m = 0; m < prepared.models.size(); ++m) {
    const ModelChoice& choice = prepared.experiment.models[m];
    if (!passes_patch_test(prepared.models[m].row)) continue;
    for (const char* option : {"min_length", "max_length", "nodes_per_m3", "seed", "seeds"})
      if (choice.options.contains(option))
        refuse_model(prepared.experiment, m,
                     fmt::format("{}: {}: the nodes of this network are the vertices of a mesh in any body but a block "
                                 "(allowed: springs_per_node; the cells' edge sets the mesh)",
                                 choice.name, option));
  }
}

/// Averaged springs and momentum dispersion of finite strain follow the material law of the case.
void choose_curve(const Experiment& e, ModelParameters& p) {
  const bool follows = p.has(Extension::averaging) || p.dispersion == Dispersion::finite_strain;
  if (!follows || p.curve) return;
  p.curve = StrainCurve::hencky;
  for (const StrainCurve curve : {StrainCurve::neo_hooke, StrainCurve::neo_hooke_isochoric})
    if (e.kinematics == name_of(curve)) p.curve = curve;
}

/// @throws InputError at a model that is of one material, in a case of several.
void check_region_models(const PreparedCase& prepared) {
  const Experiment& e = prepared.experiment;
  if (e.regions.empty()) return;
  const bool measures_regions =
      std::ranges::any_of(e.measures, [](const auto& m) { return m == "region" || m == "interface"; });
  for (std::size_t m = 0; m < prepared.models.size(); ++m) {
    const ModelParameters& p = prepared.models[m];
    const bool of_file = p.springs && !p.springs->regions.empty();  // whose regions are the case's: check_own_models
    const bool can = of_file || (has_cut_cells(p.row) && !p.springs && e.body.accuracies.empty());
    const auto refuse = [&](const char* why) { refuse_model(e, m, e.models[m].label + why); };
    if (measures_regions && can && !of_file && !*p.cut && !p.has(Extension::averaging))
      refuse(
          ": the measures region and interface are of averaged springs (allowed: hybmss_avg, cut cells, or other "
          "measures)");
    if (*p.coarsened && measures_regions)
      refuse(
          ": coarsened = true: a measured cell is of no region (allowed: without the measures region and interface)");
    if (*p.coarsened && e.listed.region > 0)
      refuse(": coarsened = true: cells are measured for one material of each region (allowed: a list in [material])");
    if (*p.coarsened && e.model_kinematics() == Kinematics::finite)  // at rest or in motion
      refuse(
          ": coarsened = true: measured cells of several materials are for small strain at rest (allowed: kinematics = "
          "\"linear\")");
    if (is_external(e.models[m]) || can) continue;
    refuse_model(
        e, m,
        fmt::format(
            "{} is of one material in a body{} (allowed beside [[region]]: lattices of cells of one size without "
            "momentum dispersion, as hybmss_avg; a springs file of such; or models = [])",
            e.models[m].label,
            has_cut_cells(p.row) ? "" : ": at an interface its springs cross, or its nodes have one dilatation"));
  }
}

/// Names of the models that can.
std::vector<std::string> able(Capability what) {
  std::vector<std::string> names;
  for (const ModelRow& row : model_table())
    if (can(row, what)) names.push_back(row.name);
  return names;
}

/// @throws InputError at a model that does not hold under the case's kinematics; `models` in the order of the case.
void check_kinematics(const Experiment& e, const std::vector<ModelParameters>& models) {
  if (e.model_kinematics() == Kinematics::linear) return;
  for (std::size_t m = 0; m < models.size(); ++m)
    if (const ModelRow& row = models[m].row; !can(row, Capability::large_displacements))
      refuse_model(e, m,
                   fmt::format("{} holds under kinematics = \"linear\" only, and the case has \"{}\" (allowed: {})",
                               row.name, e.kinematics, fmt::join(able(Capability::large_displacements), ", ")));
}

bool has_stresses(const Experiment& e, const std::string& model, const std::vector<ModelParameters>& models) {
  const auto at = std::ranges::find(e.models, model, &ModelChoice::label);
  if (at == e.models.end()) return !(e.body.is_voxels() && model.starts_with("fem_q"));
  const ModelParameters& p = models[at - e.models.begin()];
  if (is_external(*at) || at->in_motion || p.coarsened.value_or(false)) return false;
  if (p.cut.value_or(false)) return true;  // averaged springs, all of them
  return p.springs ? can(p.springs->model, Capability::recovered_stress) : can(p.row, Capability::recovered_stress);
}

/// @throws InputError for an [[expect]] of stresses that are not recovered of its model.
void check_stresses(const Experiment& e, const std::vector<ModelParameters>& models) {
  for (const Expectation& x : e.expectations)
    if (x.measure.starts_with("stress") && !has_stresses(e, x.model, models))
      throw InputError(
          x.location,
          fmt::format("measure: '{}' is not known of '{}' (allowed: of {}, and in cut cells of all lattices, "
                      "at rest and not coarsened; of elements, but not on the cubes of a body of voxels)",
                      x.measure, x.model, fmt::join(able(Capability::recovered_stress), ", ")));
}

/// @throws InputError at a model that cannot break: only springs without extensions can.
void check_fracture_models(const Experiment& e, const std::vector<ModelParameters>& models) {
  if (!e.fracture) return;
  for (std::size_t m = 0; m < models.size(); ++m) {
    const ModelParameters& p = models[m];
    const auto refuse = [&](const char* what, const char* allowed) {
      refuse_model(e, m, fmt::format("{} {} (allowed beside [fracture]: {})", p.row.name, what, allowed));
    };
    if (!p.has(Extension::none) || p.row.bending_correction || p.row.topology == Topology::hexagonal)
      refuse("has forces that no breaking spring takes away, or is planar",
             "msm_18, msm_14, msm_centred, msm_random, hybmss_cf");
    if (p.seeds > 1) refuse("has seeds of its own", "seeds in [fracture]");
    if (p.hold_rigid_motions) refuse("has the option hold_rigid_motions", "a held patch");
  }
}

/// Where a region is.
struct Place {
  double volume = 0;           ///< [m^3]
  Vec3 moment = Vec3::Zero();  ///< its integral of x [m^4]

  void add(double part, const Vec3& at) {
    volume += part;
    moment += part * at;
  }
  Vec3 centre() const { return moment / volume; }
};

/// By material: of tetrahedra.
std::vector<Place> places_of(const Mesh& body, std::size_t materials) {
  std::vector<Place> places(materials);
  const Eigen::VectorXd volumes = cell_volumes(body, body.nodes);
  for (std::size_t c = 0; c < body.materials.size(); ++c) {
    Vec3 middle = Vec3::Zero();
    for (const int n : body.tetrahedra[c]) middle += body.nodes.row(n).transpose() / 4;
    places[body.materials[c]].add(volumes[static_cast<Eigen::Index>(c)], middle);
  }
  return places;
}

/// Of cut cells, each at the middle of its cube.
std::vector<Place> places_of(const Network& network, std::size_t materials) {
  std::vector<Place> places(materials);
  for (std::size_t c = 0; c < network.cells.size(); ++c) {
    Vec3 middle = Vec3::Zero();
    for (const int n : network.cells.corners[c]) middle += network.X.row(n).transpose() / 8;
    places[network.cells.material(c)].add(network.cells.shape(c).volume(), middle);
  }
  return places;
}

}  // namespace

void check_own_regions(const PreparedCase& prepared) {
  constexpr double other_volume = 0.1;  // relative; and by more than a cell's edge elsewhere
  const Experiment& e = prepared.experiment;
  for (std::size_t m = 0; m < prepared.models.size(); ++m) {
    const ModelParameters& p = prepared.models[m];
    if (!p.springs || p.springs->regions.empty() || prepared.body.tetrahedra.empty()) continue;
    const std::vector<Place> wanted = places_of(*prepared.body.tetrahedra.back(), e.regions.size() + 1),
                             found = places_of(p.springs->model.network, e.regions.size() + 1);
    for (std::size_t r = 1; r < wanted.size(); ++r) {
      const bool same = std::abs(found[r].volume / wanted[r].volume - 1) < other_volume &&
                        (found[r].centre() - wanted[r].centre()).norm() < p.springs->model.network.cells.edge;
      if (same) continue;
      const Vec3 is = found[r].centre(), should = wanted[r].centre();
      throw InputError(e.models[m].where,
                       fmt::format("compare.models: {}: /cells/material: '{}' has {:.4g} m^3 about ({:.4g}, {:.4g}, "
                                   "{:.4g}) m (allowed: the case's, {:.4g} m^3 about ({:.4g}, {:.4g}, {:.4g}) m)",
                                   e.models[m].label, e.regions[r - 1].name, found[r].volume, is[0], is[1], is[2],
                                   wanted[r].volume, should[0], should[1], should[2]));
    }
  }
}

void choose_models(PreparedCase& prepared) {
  const Experiment& e = prepared.experiment;
  for (const ModelChoice& choice : e.models) {
    prepared.models.push_back(is_external(choice) ? parameters_of_external(choice) : resolve(choice));
    choose_curve(e, prepared.models.back());
  }
  check_own_models(prepared);
  check_kinematics(e, prepared.models);
  check_fracture_models(e, prepared.models);
  choose_cut_cells(prepared);
  choose_measured_cells(prepared);
  check_stresses(e, prepared.models);
  check_region_models(prepared);
  check_vertex_options(prepared);
}

}  // namespace springproof
