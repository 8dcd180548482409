// A case made ready to run: meshed, its models resolved, its loads tried on the mesh.
#pragma once

#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "comparisons/judge/patch_mean.h"
#include "meshes/mesh.h"
#include "msm/parameters/model_table.h"
#include "msm/topology/region.h"
#include "problem/case_file/experiment.h"

namespace springproof {

/// The body at one resolution of the case.
struct Lattice {
  Cells cells;  ///< of a block; of a body of voxels those of the box around it
  std::shared_ptr<const Mesh> mesh;
  double voxel_edge = 0;                        ///< [m]; 0: a block
  std::shared_ptr<const Region> region = {};    ///< the true body where cubes stand for it, else empty
  std::shared_ptr<const Mesh> tetrahedra = {};  ///< of a body of voxels with edges as long as the cubes', where
                                                ///< elements on them are compared, else empty
  Eigen::Index first_node = 0;                  ///< row of fem::Solution::displacement that its nodes begin at
};

/// What a lattice node of a body of voxels takes from the finite elements' displacements at PreparedCase::body_points:
/// that at `at`, or outside the body 2 u(at) - u(within): the displacement of the nearest place of the surface,
/// continued linearly.
struct BodySample {
  int at;
  int within = -1;  ///< as far behind the surface as the node is in front of it; -1: the node itself is in the body
};

/// An experiment made ready.
struct PreparedCase {
  Experiment experiment;          ///< as read
  std::vector<Load> loads;        ///< its loads; of a body of voxels with the wrenches that they have on the true body
  Vec3 size = Vec3::Zero();       ///< of the body [m]; of a body of voxels that of the box around it
  std::vector<Lattice> lattices;  ///< one per resolution
  std::vector<std::shared_ptr<const Mesh>>
      tetrahedra;  ///< of a body of voxels: three meshes, coarse to fine (the last is the true body)
  std::vector<int>
      uncut;  ///< numbers of their tetrahedra before borders of patches were cut: these tell the meshes' ratios
  double load_spread = 0;  ///< relative: what loads by area or volume differ by between the two finest
  NodalVectors body_points = NodalVectors(0, 3);  ///< where its finite elements are asked for their displacement,
  std::vector<BodySample> body_samples;           ///< from which each lattice node takes its own
  std::vector<std::string> notes;                 ///< what was mended or left out of the body
  std::vector<PatchSamples> patch_samples;        ///< of the body's patches, where mean_displacement is measured
  std::vector<ModelParameters> models;
  Cells reference_cells = {0, 0, 0};  ///< finest of the three reference grids
  std::set<std::string> sharing;      ///< patches whose separate forces are a convention
  std::filesystem::path geo;          ///< the body's file

  /// Nodes of all lattices: the row of fem::Solution::displacement that the measured points begin at.
  Eigen::Index nodes() const {
    return lattices.empty() ? 0 : lattices.back().first_node + lattices.back().mesh->nodes.rows();
  }
};

/// Adds the next lattice.
void add_lattice(Lattice lattice, PreparedCase& prepared);

/// Number of the lattice with the most cells.
std::size_t finest_lattice(const PreparedCase& prepared);

/// Of the elements compared beside the models, those of hexahedra ('q') or of tetrahedra ('p').
std::vector<std::string> elements_of(const Experiment& experiment, char shape);

/// False for a run with more unknowns than [compare] max_unknowns: about three per node of its mesh, and eight times
/// as many for elements of degree 2.  Of a model the degree is 1.
bool small_enough(const Experiment& experiment, const Mesh& mesh, int degree = 1);

}  // namespace springproof
