// One case at one of its settings, while it is being run.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "comparisons/judge/deformation.h"
#include "comparisons/judge/reference_value.h"
#include "comparisons/judge/stress_error.h"
#include "comparisons/models/motion_reference.h"
#include "comparisons/prepare/prepared_case.h"
#include "comparisons/reference/reference_grids.h"
#include "comparisons/reference/voxel_reference.h"
#include "comparisons/reference/vtu_output.h"
#include "comparisons/results/records.h"
#include "comparisons/run/cut_extrapolation.h"

namespace springproof {

/// The finite element reference at the nodes of one lattice.
struct Reference {
  ReferenceField field;
  std::map<std::string, ReferenceValue> scalars;  ///< the same for every lattice
  DisplacementScale scale;                        ///< what errors of the displacement are relative to
};

/// Its inputs, what is known of it so far, and its results.
struct PartRun {
  const PreparedCase& prepared;
  const IsotropicMaterial& material;
  const VtuOutput& vtu;
  const RunKeeper& keeper;
  Part part;

  ReferenceGrids grids;                             ///< no elements: no reference
  std::vector<std::optional<Reference>> reference;  ///< one per lattice; empty: no reference
  std::vector<std::optional<VoxelLimit>> voxels;    ///< one per lattice of a body of voxels
  std::optional<StressLimit> stress;                ///< at stress_points(), where the case compares them
  std::vector<CutState> cut_states;
  std::optional<MotionReference> in_time;  ///< finite elements in time, where there are

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

}  // namespace springproof
