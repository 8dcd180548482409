// A case prepared for its runs: meshed, its models resolved, its loads checked on the mesh.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "comparisons/judge/patch_mean.h"
#include "comparisons/prepare/measured_lattice.h"
#include "comparisons/results/records.h"
#include "meshes/mesh.h"
#include "meshes/surface/surface.h"
#include "msm/embedding/cut_lattice.h"
#include "msm/models.h"
#include "msm/topology/region.h"
#include "problem/case_file/experiment.h"

namespace springproof {

/// Checksum of what a case is computed from: the files of its body and the springs files of its models.
/// @throws InputError if there is no such body.
std::string input_checksum(const Experiment& experiment);

/// Networks on the vertices of one mesh whose springs pass the patch test: each is fitted once, for all materials.
class FittedNetworks {
 public:
  /// Thread-safe.
  /// @throws as fitted_on_vertices()
  const Network& of(const ModelParameters& parameters, const Mesh& tetrahedra);

 private:
  std::mutex one_at_a_time_;
  std::map<double, Network> by_springs_per_node_;
};

/// The body at one resolution of the case.
struct Lattice {
  Cells cells;  ///< of a block; for a body of voxels those of its bounding box
  std::shared_ptr<const Mesh> mesh;
  double voxel_edge = 0;                        ///< [m]; 0: a block
  std::shared_ptr<const Region> region = {};    ///< the true body if cubes represent it, else empty
  std::shared_ptr<const Mesh> tetrahedra = {};  ///< for a body of voxels, with edges as long as the cubes', if
                                                ///< elements or networks on them are compared, else empty
  std::shared_ptr<FittedNetworks> fits = std::make_shared<FittedNetworks>();  ///< on the vertices of `tetrahedra`
  std::shared_ptr<const CutBody> cut = {};         ///< of a body of voxels, if a model takes cut cells, else empty
  std::shared_ptr<MeasuredLattice> measured = {};  ///< of cut cells, if a model takes measured ones, else empty
  double estimated = 0;                            ///< error of a refined lattice; 0: its cells are of one size
  double falls_short = 1;                          ///< by what its estimates must be multiplied
  Eigen::Index first_node = 0;                     ///< first row of its nodes in fem::Solution::displacement

  /// What errors of cut cells are proportional to: the edge of the cells, or the estimated error of those of several
  /// sizes.
  double error_scale() const { return estimated > 0 ? estimated : voxel_edge; }
};

/// The body, and the meshes that finite elements take of it.
struct BodyOfCase {
  std::filesystem::path geo;  ///< its file
  Vec3 size = Vec3::Zero();   ///< [m]; for a body of voxels that of its bounding box
  std::vector<std::shared_ptr<const Mesh>>
      tetrahedra;  ///< for a body of voxels: three meshes, coarse to fine (the last is the true body)
  std::vector<int>
      uncut;  ///< numbers of their tetrahedra before borders of patches were cut, which determine the refinement ratios
  std::shared_ptr<const Mesh> of_regions;  ///< with the materials of its cells, the finest; of one material none
  std::shared_ptr<const Surface> facets;   ///< of a surface file, for weight and patches; else none
  std::map<std::string, Vec3> centroids;   ///< of patches by rules, of those facets
  double chords = 0;       ///< by what share facets may change displacements where the body is smooth; 0: it is not
  double load_spread = 0;  ///< relative difference of loads by area or volume between the meshes
  std::vector<std::string> notes;  ///< what was repaired or left out of the body

  void note(const std::vector<std::string>& more) { notes.insert(notes.end(), more.begin(), more.end()); }
};

/// How the displacement at a lattice node of a body of voxels follows from the finite elements' at Samples::points:
/// u(at), or outside the body 2 u(at) - u(within), linear extrapolation from the nearest point of the surface.
struct NodeSample {
  int at;
  int within = -1;  ///< mirror image of the node, or `at` if that is not in the body; -1: the node is in the body
};

/// Where displacements are wanted besides at the nodes of a block's lattices.
struct Samples {
  NodalVectors points = NodalVectors(0, 3);  ///< of a body of voxels, instead of those nodes
  std::vector<NodeSample> of_nodes;          ///< how those of the nodes of all lattices follow
  std::vector<PatchSamples> of_patches;      ///< where mean_displacement is measured
};

/// An experiment made ready.
struct PreparedCase {
  Experiment experiment;    ///< as read
  std::vector<Load> loads;  ///< its loads; for a body of voxels with their resultants on the true body
  BodyOfCase body;
  std::vector<Lattice> lattices;  ///< one per resolution
  Samples samples;
  std::vector<ModelParameters> models;
  Cells reference_cells = {0, 0, 0};  ///< finest of the three reference grids
  std::set<std::string> sharing;      ///< patches whose separate forces are a convention
  std::vector<LatticeLimit> limits;   ///< models that the imposed strain may be too much for

  /// Nodes of all lattices: the first row of the measured points in fem::Solution::displacement.
  Eigen::Index nodes() const {
    return lattices.empty() ? 0 : lattices.back().first_node + lattices.back().mesh->nodes.rows();
  }
};

/// The case with one material of each region (Experiment::at); meshes and lattices are shared.
PreparedCase at_setting(const PreparedCase& prepared, std::size_t setting);

/// Builds a model on a lattice, of cut cells if ModelParameters::cut says so.  `in_motion`: every free node has a mass.
EmbeddedModel build_on(const PreparedCase& prepared, const Lattice& lattice, const ModelParameters& parameters,
                       const IsotropicMaterial& material, bool in_motion);

/// Builds a model of the cut cells of a lattice, measured ones if ModelParameters::coarsened says so.
/// @param held names of the patches that anchors hold
/// @param regions materials of the body's regions
EmbeddedModel build_cut_on(const Lattice& lattice, const ModelParameters& parameters,
                           const std::vector<std::string>& held, const IsotropicMaterial& material,
                           const std::vector<IsotropicMaterial>& regions = {});

/// The cut cells that a model of a lattice is made of.
const CutBody& cells_of(const Lattice& lattice, const ModelParameters& parameters);

/// Adds the next lattice.
void add_lattice(Lattice lattice, PreparedCase& prepared);

/// The loads that transfer() takes: all but the body forces of exact fields.
std::vector<Load> lattice_loads(const PreparedCase& prepared);

/// Number of the lattice with the most cells.
std::size_t finest_lattice(const PreparedCase& prepared);

/// Of the elements compared beside the models, those of hexahedra ('q') or of tetrahedra ('p').
std::vector<std::string> elements_of(const Experiment& experiment, char shape);

/// False for a run with more unknowns than [compare] max_unknowns: about three per node of its mesh, and eight times
/// as many for elements of degree 2.  For a model the degree is 1.
bool small_enough(const Experiment& experiment, const Mesh& mesh, int degree = 1);

}  // namespace springproof
