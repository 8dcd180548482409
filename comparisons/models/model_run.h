// One spring model on one lattice at one material: solved, over all its seeds, and measured.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "comparisons/models/motion_run.h"
#include "comparisons/prepare/prepared_case.h"
#include "comparisons/results/records.h"
#include "msm/measure/promised_error.h"
#include "msm/statics/equilibrium.h"
#include "problem/system/run_cost.h"

namespace springproof {

/// Results of one network.
struct ModelSample {
  Equilibrium state;
  RunTimes times;
  Field field;                              ///< on the lattice's mesh; empty where state.ok is false
  std::map<std::string, double> scalars;    ///< every measure that has a value of its own
  std::optional<LineRecord> line;           ///< where the case has one
  MotionRecord motion;                      ///< empty: the model is solved for its equilibrium
  std::optional<Stability> stability = {};  ///< of a lattice of cells
  NodalStresses stress = {};                ///< recovered_stress(), where the case compares it and the model has it
};

/// A model of a case on one of its lattices, with what was solved.
struct SolvedModel {
  EmbeddedModel built;
  BoundaryConditions conditions;
  Equilibrium state;
  RunTimes times;
  MotionRecord motion;
};

/// The loads of a case at a fraction of them, on a model.
BoundaryConditions conditions_of(const PreparedCase& prepared, const Lattice& lattice,
                                 const ModelParameters& parameters, const EmbeddedModel& built, double density,
                                 double factor = 1.0);

/// What is measured of it.
ModelSample measured(const PreparedCase& prepared, const Lattice& lattice, const ModelParameters& parameters,
                     SolvedModel solved, bool in_motion);

/// Rows of the measure `network`.
void add_network(const Network& network, std::map<std::string, double>& out);

/// A model of the case.
struct ChosenModel {
  std::size_t number;
  bool whole_cubes = false;  ///< also where the case chose cut cells
};

/// Solves a model on a lattice; one sample per seed.  Of displacements of another program: external_samples().
std::vector<ModelSample> run_samples(const PreparedCase& prepared, const Lattice& lattice, ChosenModel model,
                                     const IsotropicMaterial& material);

}  // namespace springproof
