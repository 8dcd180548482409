#include "comparisons/prepare/region_notes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "meshes/united_numbers.h"
#include "meshes/volume.h"

namespace springproof {
namespace {

constexpr double few_cells = 2, enough_cells = 4;  // across a region
constexpr double thin = 0.3;                       // cells
constexpr double least_part = 1e-3;                // of a cube, that is kept of a body

/// Tetrahedra of one material that hang together by facets, or all of it.
struct MaterialPart {
  double volume = 0, area = 0;  ///< [m^3], [m^2]
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  std::set<int> beside;  ///< materials across its facets; -1: the outside

  double thickness() const { return 2 * volume / area; }
  /// Of a ball its diameter, of a sheet along the axes its thickness.
  double across() const { return std::min(3 * thickness(), (high - low).minCoeff()); }
};

/// The two tetrahedra at each facet, the second -1 on the outside.
std::map<std::array<int, 3>, std::array<int, 2>> facets_of(const Mesh& body) {
  std::map<std::array<int, 3>, std::array<int, 2>> facets;
  for (std::size_t c = 0; c < body.tetrahedra.size(); ++c)
    for (int without = 0; without < 4; ++without) {
      std::array<int, 3> facet{};
      for (int i = 0, n = 0; i < 4; ++i)
        if (i != without) facet[n++] = body.tetrahedra[c][i];
      std::ranges::sort(facet);
      const auto [at, first] = facets.emplace(facet, std::array{static_cast<int>(c), -1});
      if (!first) at->second[1] = static_cast<int>(c);
    }
  return facets;
}

/// @param part_of the part of each tetrahedron
std::map<int, MaterialPart> parts_of(const Mesh& body, const std::vector<int>& part_of) {
  const Eigen::VectorXd volumes = cell_volumes(body, body.nodes);
  std::map<int, MaterialPart> parts;
  for (std::size_t c = 0; c < body.tetrahedra.size(); ++c) {
    MaterialPart& part = parts[part_of[c]];
    part.volume += volumes[static_cast<Eigen::Index>(c)];
    for (const int n : body.tetrahedra[c]) {
      part.low = part.low.cwiseMin(body.nodes.row(n).transpose());
      part.high = part.high.cwiseMax(body.nodes.row(n).transpose());
    }
  }
  for (const auto& [facet, cells] : facets_of(body)) {
    const auto X = [&](int i) -> Vec3 { return body.nodes.row(facet[i]).transpose(); };
    const double area = (X(1) - X(0)).cross(X(2) - X(0)).norm() / 2;
    const auto material = [&](int cell) { return cell < 0 ? -1 : body.materials[cell]; };
    for (int side = 0; side < 2; ++side) {
      const int own = cells[side], other = cells[1 - side];
      if (own < 0 || (other >= 0 && part_of[own] == part_of[other])) continue;
      parts[part_of[own]].area += area;
      parts[part_of[own]].beside.insert(material(other));
    }
  }
  return parts;
}

/// Of each material all.
std::map<int, MaterialPart> by_material(const Mesh& body) {
  return parts_of(body, {body.materials.begin(), body.materials.end()});
}

/// Of what is in no region, each connected part.
std::map<int, MaterialPart> between_regions(const Mesh& body) {
  UnitedNumbers together(body.tetrahedra.size());
  for (const auto& [facet, cells] : facets_of(body))
    if (cells[1] >= 0 && body.materials[cells[0]] == body.materials[cells[1]]) together.unite(cells[0], cells[1]);
  std::vector<int> part_of(body.tetrahedra.size());
  for (std::size_t c = 0; c < part_of.size(); ++c)
    part_of[c] = body.materials[c] == 0 ? together.of(static_cast<int>(c)) : -1;
  std::map<int, MaterialPart> parts = parts_of(body, part_of);
  parts.erase(-1);
  return parts;
}

std::string gap_note(const std::vector<MaterialRegion>& regions, const MaterialPart& gap, double edge, double whole) {
  std::vector<std::string> names;
  for (const int r : gap.beside)
    if (r > 0) names.push_back("'" + regions[r - 1].name + "'");
  if (names.size() == 1) names.emplace_back("the surface");
  return fmt::format("a gap of {:.2g} cells between {}, {:.2g} % of the volume, is filled with [material]",
                     gap.thickness() / edge, fmt::join(names, " and "), 100 * gap.volume / whole);
}

[[noreturn]] void refuse_unresolved(const MaterialRegion& region, const MaterialPart& part, double edge,
                                    const char* which) {
  throw InputError(region.where,
                   fmt::format("region: '{}', of {:.3g} m³, fills less than 1/1000 of {} cube of {:.3g} m (allowed: "
                               "voxel_edge_m up to {:.2g}, a quarter of what it is across)",
                               region.name, part.volume, which, edge, part.across() / enough_cells));
}

}  // namespace

std::vector<std::string> region_notes(const std::vector<MaterialRegion>& regions, const Mesh& body, double edge) {
  std::vector<std::string> notes;
  double whole = 0;
  for (const auto& [material, part] : by_material(body)) {
    whole += part.volume;
    if (material == 0) continue;
    const std::string& name = regions[material - 1].name;
    if (part.thickness() < thin * edge)
      notes.push_back(fmt::format(
          "region '{}' is {:.2g} cells thick in the mean: it stretches as it should, its own bending is too stiff",
          name, part.thickness() / edge));
    else if (part.across() < few_cells * edge)
      notes.push_back(fmt::format(
          "region '{}' is about {:.2g} cells across: what it does to the body is 30 to 80 % off, at {:g} across, in "
          "cells of {:.2g} m, 1 to 6 %",
          name, part.across() / edge, enough_cells, part.across() / enough_cells));
  }
  for (const auto& [number, gap] : between_regions(body))
    if (gap.thickness() < edge && *gap.beside.rbegin() > 0) notes.push_back(gap_note(regions, gap, edge, whole));
  return notes;
}

void require_resolved(const std::vector<MaterialRegion>& regions, const Mesh& body, double edge) {
  for (const auto& [material, part] : by_material(body))
    if (material > 0 && part.volume < least_part * std::pow(edge, 3))
      refuse_unresolved(regions[material - 1], part, edge, "a");
}

void refuse_smallest(const std::vector<MaterialRegion>& regions, const Mesh& body, double edge) {
  const std::map<int, MaterialPart> parts = by_material(body);
  const auto smallest = std::ranges::min_element(
      parts, {}, [](const auto& p) { return p.first > 0 ? p.second.volume : std::numeric_limits<double>::infinity(); });
  refuse_unresolved(regions.at(smallest->first - 1), smallest->second, edge, "every");
}

}  // namespace springproof
