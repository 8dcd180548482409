#include "comparisons/reference/reference_grids.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "comparisons/prepare/rims.h"
#include "meshes/quality.h"
#include "meshes/surface/surface.h"
#include "meshes/volume.h"
#include "problem/case_file/measures.h"

namespace springproof {
namespace {

constexpr double locks_above = 0.4;         // Poisson's ratio, of linear elements
constexpr double differing_surface = 1e-3;  // of the volume, between the two finest meshes

struct Question {
  const PreparedCase& prepared;
  const IsotropicMaterial& material;
  const ElementGrids& grids;
  const std::string& measure;

  bool voxels() const { return prepared.experiment.body.is_voxels(); }
};

using Clause = std::optional<std::string>;

std::string finer_cells(const Cells& cells) {
  std::vector<int> finer;
  for (const int n : cells) finer.push_back(n == 1 ? 1 : 2 * n);  // one cell: plane strain
  return fmt::format("[reference] cells = [{}]", fmt::join(finer, ", "));
}

std::string finer_grid(const Question& q) {
  return q.voxels() ? fmt::format("[reference] edge_m = {:.2g}", element_size(q.prepared) / 1.5)
                    : finer_cells(q.grids.grids.back().grid.cells);
}

Clause meshes_of_one_fineness(const Question& q) {
  if (are_refined(ratios_of(q.grids))) return {};
  return fmt::format(
      "the surface sets the size of the tetrahedra on all three meshes: {}, or a file with a coarser surface",
      finer_grid(q));
}

Clause element_that_locks(const Question& q) {
  if (q.grids.element[1] != '1' || q.material.poisson_ratio <= locks_above) return {};
  return fmt::format("linear elements are slow near nu = 1/2: [reference] elements = [\"{}2\"]", q.grids.element[0]);
}

Clause probe_at_a_rim(const Question& q) {
  std::vector<Probe> probes = q.prepared.experiment.probes;
  std::erase_if(probes, [&](const Probe& p) { return q.measure.find('.' + p.name + '.') == std::string::npos; });
  for (const auto& rim : rims_near(q.prepared, probes))
    if (rim)
      return fmt::format(
          "the probe lies {:.2g} m from the rim of patch '{}', less than an element ({:.2g} m): move it "
          "away, or {}",
          rim->distance, rim->patch, element_size(q.prepared), finer_grid(q));
  return {};
}

Clause differing_surfaces(const Question& q) {
  const auto& meshes = q.prepared.body.tetrahedra;
  if (meshes.size() < 2) return {};
  const auto volume_of = [&](std::size_t from_last) {
    const Mesh& m = *meshes[meshes.size() - from_last];
    return volume(m, m.nodes);
  };
  const double off = std::abs(volume_of(2) / volume_of(1) - 1);
  if (off < differing_surface) return {};
  return fmt::format("the surface differs from mesh to mesh, by {:.2g} % of the volume: {}", 100 * off, finer_grid(q));
}

Clause differing_rim(const Question& q) {
  for (const std::string& name : ragged_patches(q.prepared))
    return fmt::format(
        "patch '{}' by its facets' normals (facing) ends elsewhere on every mesh: add a plane or a "
        "sphere (beyond, box_m, near), which facets are cut along",
        name);
  return {};
}

/// A body of parts that are thinner (2 volume / surface) than an element of the coarsest mesh.
Clause thin_parts(const Question& q) {
  if (q.prepared.body.tetrahedra.empty()) return {};
  const Mesh& body = *q.prepared.body.tetrahedra.back();
  const double inside = volume(body, body.nodes), thick = 2 * inside / area(outside_of(body)),
               coarsest = edge_of_regular(inside, q.prepared.body.uncut.front());
  if (coarsest < thick) return {};
  return fmt::format(
      "the coarsest mesh, of elements of {:.2g} m, has one across parts of {:.2g} m: [reference] edge_m = {:.2g}",
      coarsest, thick, element_size(q.prepared) * std::min(thick / coarsest, 1 / 1.5));
}

Clause coarse_across(const Question& q) {
  const Cells& cells = q.grids.grids.back().grid.cells;
  if (q.voxels() || std::ranges::none_of(cells, [](int n) { return n > 1 && n < two_on_the_coarsest; })) return {};
  return fmt::format("the coarsest grid has one cell across: {}", finer_cells(cells));
}

std::string singular_rims(const Question& q) {
  const std::vector<std::string> held = supported_patches(q.prepared.experiment);
  return held.empty() ? "a finer grid may tell: " + finer_grid(q)
                      : fmt::format("stresses are singular at the rim{} of {}: {}", held.size() == 1 ? "" : "s",
                                    fmt::join(held, ", "), finer_grid(q));
}

}  // namespace

std::string cause_and_remedy(const PreparedCase& prepared, const IsotropicMaterial& material, const ElementGrids& grids,
                             const std::string& measure) {
  const Question q{prepared, material, grids, measure};
  for (const auto clause : {meshes_of_one_fineness, element_that_locks, probe_at_a_rim, differing_surfaces,
                            differing_rim, thin_parts, coarse_across})
    if (const Clause cause = clause(q)) return *cause;
  return singular_rims(q);
}

}  // namespace springproof
