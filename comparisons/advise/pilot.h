// A case solved on coarse lattices by its models: errors that finer lattices will have.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "comparisons/advise/speed.h"
#include "comparisons/prepare/prepared_case.h"
#include "meshes/mesh.h"
#include "problem/material.h"

namespace springproof {

/// Shares of a body's strain energy, by what the sections normal to an axis do: they move apart (axial), tilt
/// (bending), turn (torsion), slide (shear); the rest is strain that varies within a section (local), as beside
/// supports and in limbs.  The sum is 1.
struct LoadShares {
  double axial = 0, bending = 0, torsion = 0, shear = 0, local = 0;
  int axis = 0;  ///< 0: x

  std::string largest() const;  ///< of the first four, the load by which the body is classified
};

/// About the axis that leaves the least rest, of equals the shortest.  For a displacement [m] at the nodes of a mesh of
/// cubes (small strains).
LoadShares load_shares(const Mesh& mesh, const NodalVectors& displacement, const IsotropicMaterial& material);

/// The model whose solves, extrapolated, stand for the truth of a case; their time scales what the machine is measured
/// at.
inline constexpr const char* pilot_reference_model = "hybmss_avg";

/// Rows of the model table that are advised where none is asked for.
inline const std::vector<std::string> usual_models = {"hybmss_avg", "hybmss_bt", "hybmss",
                                                      "emsm",       "msm_18",    "emsm_patch"};

/// What is predicted of a displacement error.
struct Prediction {
  double error = 0;     ///< as a part of the displacement
  double factor = 1;    ///< nine of ten true errors lie between error / factor and error * factor
  bool beyond = false;  ///< beyond what was solved or measured
};

/// The square of a norm along the line a + t b of fields.
struct SquaredLine {
  double aa = 0, ab = 0, bb = 0;
  double at(double t) const { return aa + 2 * t * ab + t * t * bb; }
};

/// One model or finite element of a case on coarse lattices.
struct PilotModel {
  std::string label;
  std::optional<StepCost> step = {};  ///< in cut cells: measured on the finest of these lattices
  std::string failure = {};           ///< why there are no errors
  std::vector<double> cells = {};     ///< of the lattices, ascending
  std::vector<double> errors = {};    ///< on them, against the pilot's reference
  double most_cells = HUGE_VAL;       ///< that it has on a lattice
  double making = 0;                  ///< of cells that are measured, or refined: CPU time per cell [s]
  std::vector<double> promised = {};  ///< of refined cells: the error on each lattice by which a case asks for it
  /// On finer lattices what the model is off from its limit falls with the edge to the power `order`.  The limit is the
  /// reference, and what falls is the excess of stiffness e / (1 - e); or, for springs of another Poisson's ratio, one
  /// of their own, a at t = 0.
  SquaredLine beyond = {};
  double order = 1;
};

struct PilotSize {
  double cells = 1500;             ///< of the finest lattice on which every model is solved
  double reference_cells = 30000;  ///< of the finest lattice of the reference
};

/// A case at one material.
struct Pilot {
  IsotropicMaterial material;
  std::vector<PilotModel> models;
  std::vector<PilotModel> elements;  ///< of a block: fem_q1, fem_q2; none where springproof-fem is not here
  double uncertainty = 0;            ///< of the reference: averaged springs on three lattices, extrapolated
  std::string reference;             ///< "hybmss_avg on 7, 14 and 28 cells across, extrapolated"
  LoadShares shares;
  double strain = 0, rotation_deg = 0;                ///< size of the deformation (comparisons/judge/deformation.h)
  bool experiment_is_linear = true;                   ///< small displacements
  double reference_cells = 0, reference_seconds = 0;  ///< of the finest solve, CPU time with set-up
  Vec3 size = Vec3::Zero();                           ///< of the body or its bounding box [m]
  double volume = 0;                                  ///< of the lattices' cells [m^3]
  Cells base = {0, 0, 0};  ///< blocks: the coarsest cubic lattice, whose multiples are the others; else 0

  const PilotModel* find(const std::string& label) const;  ///< a model or an element; null: there is none
};

/// Solves the case at one of its materials.  `models` are labels of the table's rows.
/// @throws InputError for a case that cannot be used.
Pilot solve_pilot(const Experiment& experiment, const IsotropicMaterial& material,
                  const std::vector<std::string>& models, const PilotSize& size = {});

/// What is the material has its solution as its limit, to which its errors fall.
void extrapolate_errors(PilotModel& model);

/// Springs of another Poisson's ratio have a limit of their own; `fields`, two at least, are at the nodes of `truth`.
/// @param share of the truth that errors are relative to
void extrapolate_fields(PilotModel& model, const std::vector<NodalVectors>& fields, const NodalVectors& truth,
                        const Eigen::VectorXd& weights, double share);

/// The error of a model on a lattice of so many cells: solved, interpolated, or extrapolated.
Prediction predict(const Pilot& pilot, const PilotModel& model, double cells);

}  // namespace springproof
