// The mean displacement and the turn of a patch, sampled at the same points for every discretisation.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "meshes/mesh.h"

namespace springproof {

/// Quadrature points over the facets of one patch.
struct PatchSamples {
  std::string patch;
  NodalVectors points;      ///< rest positions, n x 3 [m]
  Eigen::VectorXd weights;  ///< share of each in the patch's area, n; they sum to 1
};

/// The samples of every patch with nonzero area.  Exact for displacements that are biquadratic on its facets (quadratic
/// on triangles), as those of its elements are.
std::vector<PatchSamples> samples_of_patches(const Mesh& mesh);

/// mean_displacement.<patch>.x|y|z|magnitude [m]; `u` n x 3 at the points of all patches, one after the other.
std::map<std::string, double> mean_displacements(const std::vector<PatchSamples>& patches, const NodalVectors& u);

/// turn.<patch>.x|y|z [deg]: the vector of the rotation that is nearest to the patch's motion in the mean square.
std::map<std::string, double> turns(const std::vector<PatchSamples>& patches, const NodalVectors& u);

}  // namespace springproof
