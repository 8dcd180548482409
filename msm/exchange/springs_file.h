// A body's springs as a file, for programs that step them without this library: docs/springs_file.md.
#pragma once

#include <Eigen/SparseCore>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "msm/dynamics/terms/relaxing_cells.h"
#include "msm/embedding/embedding.h"
#include "msm/laws/laws.h"
#include "problem/material.h"

namespace springproof {

/// The true surface of the body, which the network carries: vertex v is displaced by the sum of weight (v, n) times the
/// displacement of node n.
struct EmbeddedSurface {
  NodalVectors vertices = NodalVectors(0, 3);            ///< at rest [m]
  std::vector<std::array<int, 3>> facets;                ///< outward by the right-hand rule
  Eigen::SparseMatrix<double, Eigen::RowMajor> weights;  ///< vertices x nodes; rows sum to 1
};

/// A region of the body, of another material.
struct SpringsRegion {
  std::string name;
  IsotropicMaterial material;
};

/// Where a springs file comes from.  Not read back.
struct SpringsOrigin {
  std::string program;                                                     ///< that wrote it, with its version
  std::string model;                                                       ///< its name in the table
  std::map<std::string, std::variant<bool, double, std::string>> options;  ///< of the model
  std::string input;                                                       ///< the body's file
  std::string checksum;  ///< of all files that the springs follow from
};

/// What a springs file holds.
struct SpringsFile {
  MassSpringModel model;                      ///< network and laws
  double density = 1000;                      ///< [kg/m^3]; a node's mass is this times its volume share
  std::optional<IsotropicMaterial> material;  ///< what the springs stand for; empty: not known
  std::vector<SpringsRegion> regions;         ///< of the cells of material 1, 2, ...
  RelaxingCells relaxing;                     ///< beside the laws, which are those of long times; none: elastic
  double grip = 0;  ///< depth [m] to which a support holds nodes, for nodes that are no mesh's
  bool grip_from_cells =
      false;  ///< measured from the surface of the cells that the body is cut into, not from the true one
  std::map<std::string, std::vector<int>> patches;  ///< name -> nodes that its supports hold, ascending
  std::map<std::string, std::vector<Anchor>>
      anchors;                               ///< of cut cells: name -> springs by which supports hold the patch
                                             ///< itself, each to its point (anchored_point), without nodes
  std::map<std::string, PatchShares> loads;  ///< of cut cells: name -> shares of the nodes in loads on the true patch
  Eigen::VectorXd volumes;                   ///< of cut cells: Embedding::volumes; empty: those of the masses
  EmbeddedSurface surface;                   ///< no vertices: none
  SpringsOrigin origin;                      ///< where it comes from
  std::map<std::string, double> derived;     ///< what follows from the rest, as "safe_time_step_s".  Not read back.
};

/// Reads a springs file (JSON).  Checked: the schema, that every number is finite and in range, every index a node,
/// every mass positive, every pair of nodes connected once, and that the network is in equilibrium at rest.  A network
/// of equal cells whose springs are superposed from them is recognised and gets the kernels and solvers of lattices.
/// @param file its name
/// @return the model and what belongs to it
/// @throws InputError "FILE: /pointer: what is wrong (allowed: ...)", or with line and column where it is no JSON.
SpringsFile read_springs(const std::filesystem::path& file);

/// As read_springs(), from text.
/// @param text JSON
/// @param name for messages
/// @return the model and what belongs to it
SpringsFile parse_springs(std::string_view text, const std::string& name);

/// Writes .json, .npz (the same as arrays of NumPy) or .vtu (lines for ParaView), by the ending of the name.
/// @param file its name
/// @param springs what to write
/// @throws InputError for any other ending; std::runtime_error if the file cannot be written.
void write_springs(const std::filesystem::path& file, const SpringsFile& springs);

/// Checks a name before a long computation.
/// @param file its name
/// @throws InputError unless write_springs() knows the name's ending.
void require_springs_ending(const std::filesystem::path& file);

/// The text of a springs file.
/// @param springs what to write
/// @return JSON
std::string springs_as_json(const SpringsFile& springs);

/// Smooth positions near rest [m], the same on every machine, whose forces a springs file states: what an
/// implementation of its laws is tested with.
/// @param X positions at rest [m], n x 3
/// @return positions [m], n x 3
NodalVectors check_positions(const NodalVectors& X);

/// A step of the motion by which a springs file's branches are checked: from the rest positions, relaxed, towards
/// check_positions().
struct CheckStep {
  double duration;  ///< [s]
  double progress;  ///< at its end, of the way there [1]
};

/// To half of the way, to its end, and held there, in steps of the branches' own times.
/// @param relaxation with branches
std::vector<CheckStep> check_steps(const Relaxation& relaxation);

}  // namespace springproof
