// One case: every model and the reference, at every Poisson's ratio, measured by the same ruler.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <vector>

#include "comparisons/judge/patch_mean.h"
#include "comparisons/report/results.h"
#include "meshes/mesh.h"
#include "msm/parameters/model_table.h"
#include "msm/topology/region.h"

namespace springproof {

/// What a lattice node of a body of voxels takes from the finite elements' displacements at PreparedCase::body_points:
/// that at `at`, or outside the body 2 u(at) - u(within): the displacement of the nearest place of the surface,
/// continued linearly.
struct BodySample {
  int at;
  int within = -1;  ///< as far behind the surface as the node is in front of it; -1: the node itself is in the body
};

/// An experiment made ready: meshed, its models resolved, its loads tried on the mesh.
struct PreparedCase {
  Experiment experiment;
  std::vector<std::shared_ptr<const Mesh>> meshes;  ///< one per resolution
  std::vector<std::shared_ptr<const Region>>
      regions;  ///< beside them: the true body where cubes stand for it, else empty
  std::vector<std::shared_ptr<const Mesh>>
      tetrahedra;  ///< of a body of voxels: three meshes, coarse to fine (the last is the true body)
  std::vector<int>
      uncut;  ///< numbers of their tetrahedra before borders of patches were cut: these tell the meshes' ratios
  double load_spread = 0;  ///< relative: what loads by area or volume differ by between the two finest
  std::vector<std::shared_ptr<const Mesh>>
      fitted;  ///< of it, per resolution tetrahedra with the cubes' edges, where elements on them are compared
  std::vector<double> voxel_edges;                ///< of a body of voxels, one per resolution [m]
  NodalVectors body_points = NodalVectors(0, 3);  ///< and where its finite elements are asked for their displacement,
  std::vector<BodySample> body_samples;           ///< from which each lattice node takes its own
  std::vector<std::string> notes;                 ///< what was mended or left out of the body
  std::vector<PatchSamples> patch_samples;        ///< of the body's patches, where mean_displacement is measured
  std::vector<ModelParameters> models;
  Cells reference_cells = {0, 0, 0};  ///< finest of the three reference grids
  std::set<std::string> sharing;      ///< patches whose separate forces are a convention
  std::filesystem::path geo;          ///< the body's gmsh script
};

/// False for a run with more unknowns than [compare] most_unknowns: about three per node of its mesh, and eight times
/// as many for elements of degree 2.  Of a model the degree is 1.
bool small_enough(const Experiment& experiment, const Mesh& mesh, int degree = 1);

/// @throws InputError for everything a user can get wrong, before any long work starts.
PreparedCase prepare(const Experiment& experiment);

/// The results of one case at one Poisson's ratio.
struct Part {
  std::vector<Run> runs;
  std::vector<Row> rows;
  std::vector<ReferenceRecord> references;
  std::vector<Picture> pictures;
  std::vector<LineRecord> lines;
  std::vector<ErrorSplit> splits;
  std::vector<Deformation> deformations;
};

/// Runs everything for experiment.materials[material]; writes one VTU per run into `vtu_folder` (empty: none).
/// A solver that finds no result leaves a Run with ok = false and no rows.
Part run_part(const PreparedCase& prepared, std::size_t material, const std::filesystem::path& vtu_folder);

}  // namespace springproof
