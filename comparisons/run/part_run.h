// One case at one of its settings while it is being run, and the steps of that.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "comparisons/judge/deformation.h"
#include "comparisons/judge/reference_value.h"
#include "comparisons/judge/stress_error.h"
#include "comparisons/models/fracture_run.h"
#include "comparisons/models/model_run.h"
#include "comparisons/models/motion_reference.h"
#include "comparisons/prepare/prepared_case.h"
#include "comparisons/reference/reference_grids.h"
#include "comparisons/reference/voxel_reference.h"
#include "comparisons/reference/vtu_output.h"
#include "comparisons/results/records.h"

namespace springproof {

/// The equilibrium of a model of cut cells on one lattice.
struct CutState {
  std::size_t lattice, model;
  NodalVectors displacement;  ///< of the network [m]
  NodalVectors field;         ///< of the lattice's mesh [m]
  std::map<std::string, double> scalars;
};

/// Its inputs, what is known of it so far, and its results.
struct PartRun {
  const PreparedCase& prepared;
  const IsotropicMaterial& material;
  const VtuOutput& vtu;
  const RunKeeper& keeper;
  Part part = {};

  ReferenceGrids grids = {};                             ///< no elements: no reference
  std::vector<std::optional<Reference>> reference = {};  ///< one per lattice; empty: no reference
  std::vector<std::optional<VoxelLimit>> voxels = {};    ///< one per lattice of a body of voxels
  std::optional<StressLimit> stress = {};                ///< at stress_points(), where the case compares them
  std::vector<CutState> cut_states = {};
  std::optional<MotionReference> in_time = {};  ///< finite elements in time, where there are

  const Experiment& experiment() const { return prepared.experiment; }
  const Mesh& mesh(std::size_t lattice) const { return *prepared.lattices[lattice].mesh; }
  double setting() const { return experiment().setting_of(material); }
  RunKey key(const std::string& model, const Cells& cells) const { return {model, setting(), cells}; }
  VtuNotes notes(const RunKey& key) const {
    return vtu_notes(experiment().name, key, material.youngs_modulus, vtu.single);
  }
  RunKey key(const std::string& model, std::size_t lattice) const {
    return key(model, prepared.lattices[lattice].cells);
  }
};

// The samples of a model, each a run that is kept (comparisons/reference/run_keeper.h).

/// What the samples of a model on a lattice are kept as.
std::string name_of_samples(std::size_t lattice, ChosenModel model);
nlohmann::json json_of(const std::vector<ModelSample>& samples);  ///< as they are kept

/// A model on a lattice.
std::vector<ModelSample> samples_of(const PartRun& run, std::size_t lattice, ChosenModel model);

/// The same of a body that dries.
FractureSamples fracture_samples_of(const PartRun& run, std::size_t lattice, std::size_t number);

// The finite elements.

/// What was solved: of tetrahedra those after all cuts, where grid.cells holds those before, of which the ratios are.
Cells solved_cells(const fem::Solution& solution);
std::vector<Cells> solved_cells(const ElementGrids& grids);  ///< coarse to fine

/// What is recorded of a solution.
Run fem_run(const PartRun& run, const fem::Solution& solution, const std::string& model);

/// Runs the finite elements of [reference], at rest and in time, and those beside the models; adds their records and
/// sets what the models are compared with.
void run_reference(PartRun& run);

/// Those in time: PartRun::in_time, their run and their history.
void run_motion_reference(PartRun& run);

/// What a model is compared with at rest: nothing where its motion is compared with finite elements in time, of which
/// the last instant is no equilibrium.
const Reference* reference_at_rest(const PartRun& run, std::size_t lattice, const std::string& model);

// What was measured of a run, beside the reference, as rows of results.csv.

/// A row of a run of the case, without a measure.
Row blank_row(const PartRun& run, const RunKey& key, const std::string& kinematics);

/// Adds a row of a measure, with its unit, if the case asks for it.
void add_row(PartRun& run, Row row, const std::string& measure);

/// Adds the rows of a model or element on a lattice.
/// @param u one displacement field per sample, at the lattice's nodes [m]
/// @param scalars the measures that have a value of their own, one set per sample
void add_rows(PartRun& run, std::size_t lattice, const std::string& model, const std::string& kinematics,
              const std::vector<NodalVectors>& u, const std::vector<std::map<std::string, double>>& scalars);

/// Adds the history of a motion; its frames become those of the first lattice's pictures, and a series of VTU files.
void add_motion(PartRun& run, std::size_t lattice, const std::string& model, Field field, MotionRecord motion);

/// Adds what is measured in time of one model, and its distance from the reference.
void add_motion_rows(PartRun& run, const Row& blank, const HistoryRecord& history);

// Stresses at the points where the reference's are requested.

/// Those of a model on a lattice at stress_points().
/// @param of_nodes as recovered_stress() gives them
ProbeStresses at_stress_points(const PartRun& run, std::size_t lattice, const ModelParameters& parameters,
                               const NodalStresses& of_nodes);

/// Those of finite elements on a lattice; of trilinear ones on a block the means at nodes, in which alternating
/// pressures cancel, and trilinear between them.
ProbeStresses at_stress_points(const PartRun& run, std::size_t lattice, const fem::Solution& solution);

/// Finds the reference's and records how far its grids are off, if the case compares them.
/// @param doubt of its displacement
void build_stress_limit(PartRun& run, double doubt);

/// Adds stress_error.von_mises, .hydrostatic and .principal, and where the reference's peak has a limit stress_peak,
/// whose place is Row::of.
/// @param stress at stress_points()
void add_stress_errors(PartRun& run, const RunKey& key, const std::string& kinematics, const ProbeStresses& stress);

}  // namespace springproof
