#include "comparisons/prepare/rims.h"

#include <algorithm>
#include <limits>
#include <set>

#include "meshes/patches/rim.h"
#include "meshes/quality.h"
#include "meshes/volume.h"

namespace springproof {
namespace {

constexpr double least_bend = 1e-6;  // angle between normals [rad]: less of it is a face that a rim runs across

std::set<std::string> patches_of_loads(const Experiment& e) {
  std::set<std::string> names;
  for (const Load& load : e.loads)
    if (const std::string* on = patch_of(load)) names.insert(*on);
  return names;
}

/// The rim of a patch on the finest mesh.
std::vector<RimEdge> rim_of(const PreparedCase& prepared, const std::string& name) {
  const Mesh& body = *prepared.body.tetrahedra.back();
  return rim_of(body, patch(body, name));
}

double distance(const Vec3& p, const RimEdge& e) {
  const Vec3 along = e.b - e.a;
  const double t = std::clamp(along.dot(p - e.a) / along.squaredNorm(), 0.0, 1.0);
  return (p - e.a - t * along).norm();
}

}  // namespace

double element_size(const PreparedCase& prepared) {
  const Mesh& body = *prepared.body.tetrahedra.back();
  return edge_of_regular(volume(body, body.nodes), prepared.body.uncut.back());
}

std::vector<std::optional<NearRim>> rims_near(const PreparedCase& prepared, const std::vector<Probe>& probes) {
  std::vector<std::optional<NearRim>> nearest(probes.size());
  if (prepared.body.tetrahedra.empty() || probes.empty()) return nearest;
  const double element = element_size(prepared);
  for (const std::string& name : patches_of_loads(prepared.experiment)) {
    const std::vector<RimEdge> rim = rim_of(prepared, name);
    if (ends_at_edges(rim)) continue;
    for (std::size_t i = 0; i < probes.size(); ++i) {
      NearRim here{name, std::numeric_limits<double>::infinity()};
      for (const RimEdge& e : rim) here.distance = std::min(here.distance, distance(probes[i].at, e));
      if (here.distance < element && (!nearest[i] || here.distance < nearest[i]->distance)) nearest[i] = here;
    }
  }
  return nearest;
}

std::vector<std::string> ragged_patches(const PreparedCase& prepared) {
  std::vector<std::string> ragged;
  if (prepared.body.tetrahedra.empty()) return ragged;  // the borders of blocks are lines of every grid
  const Experiment& e = prepared.experiment;
  const std::set<std::string> loaded = patches_of_loads(e);
  for (const PatchRule& rule : e.patches)
    if (rule.facing && loaded.contains(rule.name)) {
      std::vector<RimEdge> rim = rim_of(prepared, rule.name);
      std::erase_if(rim, [](const RimEdge& edge) { return edge.turn < least_bend; });  // another condition's plane
      if (!ends_at_edges(rim)) ragged.push_back(rule.name);
    }
  return ragged;
}

}  // namespace springproof
