#include "comparisons/run/own_models.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "meshes/volume.h"
#include "msm/dynamics/terms/relaxing_cells.h"
#include "msm/exchange/springs_file.h"
#include "msm/models.h"

namespace springproof {
namespace {

/// Whether they relax alike, to the digits of a file.
bool same(const RelaxingCells& a, const RelaxingCells& b) {
  const auto equal = [](double x, double y) { return std::abs(x - y) <= 1e-9 * std::max(std::abs(x), std::abs(y)); };
  const auto &p = a.relaxation.branches, &q = b.relaxation.branches;
  const HourglassStiffness &h = a.cells.hourglass, &k = b.cells.hourglass;
  return std::equal(p.begin(), p.end(), q.begin(), q.end(),
                    [&](const auto& x, const auto& y) { return equal(x.share, y.share) && equal(x.time, y.time); }) &&
         equal(a.cells.shear_modulus, b.cells.shear_modulus) && equal(h.bending, k.bending) &&
         equal(h.coupling, k.coupling) && equal(h.torsion, k.torsion) && equal(h.twist, k.twist) &&
         equal(h.warping, k.warping);
}

/// @throws InputError at a springs file that relaxes otherwise than the case's material.
void check_relaxing(const PreparedCase& prepared, std::size_t m, const IsotropicMaterial& material) {
  if (!prepared.models[m].springs) return;
  const SpringsFile& file = *prepared.models[m].springs;
  const Experiment& e = prepared.experiment;
  const auto refuse = [&](const std::string& why) {
    throw InputError(e.models[m].where, fmt::format("compare.models: {}: {}", e.models[m].label, why));
  };
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

void check_own_models(const PreparedCase& prepared) {
  const Experiment& e = prepared.experiment;
  for (std::size_t m = 0; m < prepared.models.size(); ++m)
    for (const IsotropicMaterial& material : e.materials) try {
        require_material(prepared.models[m], material);
        require_regions(prepared.models[m], e);
      } catch (const InputError& error) {
        throw InputError(e.models[m].where, fmt::format("compare.models: {}", error.what()));
      }
  for (std::size_t m = 0; m < prepared.models.size(); ++m)
    for (const IsotropicMaterial& material : e.materials) check_relaxing(prepared, m, material);
}

}  // namespace springproof
