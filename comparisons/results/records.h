// What a comparison produces: rows, references with their uncertainty, verdicts.  The only input of the report.
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "problem/case_file/experiment.h"

namespace springproof {

/// What was run: the key of a result within its case.
struct RunKey {
  std::string model;  ///< "hybmss", "fem_q1", ...; of a picture "fem" is the reference sampled at the same nodes
  double poisson_ratio = 0;
  Cells cells = {0, 0, 0};
};

/// Whether both are of one model at one Poisson's ratio and resolution.
bool same_run(const RunKey& a, const RunKey& b);

/// Name of the files of a run, without an ending: "hybmss_nu0.3_10x10x10".
std::string file_stem(const RunKey& key);

/// A record of a run, all else in it blank.
template <class Record>
Record of_run(const RunKey& key) {
  Record record;
  static_cast<RunKey&>(record) = key;
  return record;
}

/// One number of one model: a line of results.csv.
struct Row : RunKey {
  std::string case_name;
  std::string kinematics;  ///< "linear", "finite" (springs) or the FEM's law
  std::string measure;     ///< "displacement_error", "volume_change", "force.z_max.z", ...
  double value = 0;
  std::string unit;
  std::optional<double> reference;
  std::optional<double> reference_uncertainty;
  std::optional<double> error;        ///< value - reference; for measures that are errors, the value itself
  int samples = 1;                    ///< disordered networks behind the value, which is then their mean
  std::optional<double> spread = {};  ///< standard deviation over them; empty: one sample
  std::string of = {};                ///< of a reaction_error: which reaction is off, "force.z_max"
};

/// How near the state of a model is to the loss of its equilibrium, or where it was lost.
struct Stability {
  double load_reached = 1;          ///< share of the load up to which there is a stable state
  std::string lost;                 ///< why there is none beyond it: "unstable", "inverted cell", "no convergence"
  double strain = 0;                ///< largest principal strain of the state, 99 % of the volume are below [1]
  std::optional<double> softest;    ///< stiffness of the motion that the state resists least, over that at rest
  std::vector<double> alternation;  ///< of that motion along x, y, z: 0 neighbours move alike, 2 against each other
  double wrinkles = 0;  ///< strain that alternates from cell to cell, over all; of a motion the largest of each
};

/// One run of one solver.
struct Run : RunKey {
  std::string kind;  ///< "msm" or "fem"
  std::string kinematics;
  bool ok = false;
  std::string message;  ///< why there is no result, with the load reached
  std::string solver;   ///< "CG + multigrid", "Newton, 8 load steps, Cholesky", ...
  int iterations = 0;
  double residual = 0;        ///< relative
  double seconds = 0;         ///< CPU time from a discrete system with its loads to the displacement
  long unknowns = 0;          ///< unconstrained displacement components
  double memory_MiB = 0;      ///< peak resident set of the solver's process up to the end of this run; in an experiment
                              ///< with `cost` the growth due to the run
  double set_up_seconds = 0;  ///< CPU time from the mesh in memory to that system
  std::optional<Stability> stability = {};  ///< of models that are lattices of cells
  std::size_t filled = 0;                   ///< number of its cells in the body, cut ones counted whole; 0: unknown
};

/// Uncertainty of the reference for one measure: three grids, observed order, Richardson limit, GCI.
struct ReferenceRecord {
  double poisson_ratio = 0;
  std::string measure;
  std::string unit;
  std::vector<Cells> cells;              ///< of the grids, coarse to fine
  std::vector<double> values;            ///< on each grid
  std::optional<double> observed_order;  ///< empty: the sequence is not monotone
  double value = 0;                      ///< extrapolated (or the finest where it cannot be)
  double uncertainty = 0;
  std::string note;                        ///< "Richardson", "not monotone: spread of the three grids", ...
  std::string element = "q2";              ///< of [reference] elements
  bool converging = true;                  ///< false: no order can be observed, the value is that of the finest grid
  std::optional<double> correlation = {};  ///< of a field: correlation of its two differences, -1 to 1
};

enum class Verdict { pass, fail, reference_too_coarse, no_reference, no_result };
std::string to_string(Verdict verdict);

/// The verdict on one [[expect]].
struct Check : RunKey {
  std::string measure;
  std::string unit;
  std::string source;  ///< "analytic", "extrapolated FEM", "published", "regression"
  double expected = 0;
  std::optional<double> computed;
  double within = 0;  ///< absolute
  std::optional<double> reference_uncertainty;
  Verdict verdict = Verdict::no_result;
  std::string where;
  bool at_least = false;  ///< holds when computed >= expected; no tolerance
};

/// One [[published]] value beside ours.
struct PublishedRow : RunKey {
  std::string measure;
  std::string unit;
  double published = 0;
  std::optional<double> computed;
  std::string where;
  std::string remark;
};

/// Splits a model's difference from the body-fitted reference by source, on a body of voxels.  For a scalar measure the
/// three parts add up to the total; for displacement_error each is the norm of its own field, over the reference's
/// norm.
struct ErrorSplit : RunKey {
  double voxel_edge_m = 0;
  std::string measure;
  std::string unit;
  double total = 0;                 ///< model - body-fitted limit
  double model_error = 0;           ///< model - eight-node elements on the same voxels
  double discretisation_error = 0;  ///< those - the limit of refined elements on the same voxels
  double geometry_error = 0;        ///< that limit - body-fitted limit
  double uncertainty = 0;           ///< of the body-fitted limit and the facets, and so of the total
  double voxel_uncertainty = 0;     ///< of the limit on the voxels
  double facets = 0;  ///< the most that a smooth body's facets, which are chords, may add; 0: below a tenth of `total`
};

/// The deformed surface of one run, for the report's 3D view.
struct Picture : RunKey {
  std::vector<float> rest;           ///< surface nodes, xyz xyz ... [m]
  std::vector<float> displacement;   ///< same length [m]
  std::vector<float> difference;     ///< |u - u_fem| per surface node [m]; empty for "fem"
  std::vector<int> quads;            ///< 4 surface-node numbers per facet; of a triangle the last is -1
  std::vector<float> volume_change;  ///< V'/V - 1, mean over the cells at each surface node [1]
  std::string surface = "cells";  ///< "cells": outer facets of the mesh; "smooth": the true surface, carried by voxels
  std::vector<float> von_mises =
      {};  ///< stress of the reference on its finest grid, per surface node [Pa]; empty: none
  std::vector<double> frame_times = {};                  ///< of the animation of a motion [s]
  std::vector<std::vector<float>> frames = {};           ///< displacement at each of these times, as `displacement` [m]
  std::map<std::string, std::vector<int>> patches = {};  ///< surface nodes of each patch of the mesh, ascending
};

/// xx yy zz xy yz xz at each point of a line, one point after the other.
using LineTensors = std::vector<double>;

/// Strain and stress of one model along the case's line; of several networks, of the first.
struct LineRecord : RunKey {
  int first = 0, last = 0;                 ///< range of points, from 1, over which deviations are averaged
  std::vector<double> distance;            ///< of each point from the line's start [m]
  LineTensors strain;                      ///< [1]
  LineTensors stress;                      ///< [Pa]; empty: the model has forces other than spring tensions
  LineTensors exact_strain, exact_stress;  ///< Kelvin's
};

/// Label of finite elements in time.
inline constexpr const char* fem_in_motion = "fem in motion";

/// What is recorded of a motion at one time after the other; of several networks, of the first.
struct HistoryRecord : RunKey {
  std::string integrator;          ///< in words
  double time_step = 0;            ///< [s]
  std::vector<double> time;        ///< [s]
  std::vector<std::string> names;  ///< of the quantities: "kinetic_energy", "force.z_max.z", "displacement.tip.z", ...
  std::vector<std::string> units;
  std::vector<std::vector<double>> values;  ///< of each quantity, one per time
  /// What was measured: "period" [s], "amplitude" [m] and, of a pulse, "arrival" [s], of a damped motion
  /// "damping_ratio" of `probe`; "energy_drift", "momentum_drift", "angular_momentum_drift", "inertia_excess" [1];
  /// "motion_error" of a model, "uncertainty" of finite elements [1].
  std::map<std::string, double> measured;
  std::string probe;  ///< "displacement.tip.z"
};

/// Cracks of a model in a body that dries, means over its samples; the picture is of the first.
struct CrackRecord : RunKey {
  std::vector<double> shrinkage;   ///< at the top, after some of the steps [1]
  std::vector<double> broken;      ///< share of the springs [1]
  std::vector<double> fragments;   ///< of the top
  std::vector<double> stored;      ///< energy [J]
  std::vector<double> released;    ///< energy [J]
  std::vector<double> directions;  ///< share of the cracks' weight, per bin of their angle with x, 0 to 180 degrees
  std::string svg;                 ///< seen from above
};

/// Size of the deformation of a case's reference at one Poisson's ratio (comparisons/judge/deformation.h).
struct Deformation {
  double poisson_ratio = 0;
  double principal_strain = 0;  ///< [1]
  double rotation_deg = 0;
  double strained_share = 1;      ///< of the displacement, which errors are relative to (judge/deformation.h) [1]
  Vec3 applied_N = Vec3::Zero();  ///< sum of the loads
  Vec3 reacted_N = Vec3::Zero();  ///< sum of the supports' forces in the reference, on its finest grid
};

/// A model whose lattice is not stable at the strain that moved supports impose, or a quarter more, as a body has in
/// places: known before it is run.
struct LatticeLimit {
  std::string model;
  double poisson_ratio = 0;
  double imposed = 0;          ///< nominal strain along an axis, negative in compression [1]
  std::optional<double> free;  ///< the last stable strain with free sides [1]; empty: all are
  std::optional<double> held;  ///< the same with held sides
  std::string wave;            ///< what happens beyond it, in words
  std::string instead;         ///< a model of the table that is stable there; empty: none is known
};

/// The rows behind measured values, of the first model and of elements on the same cells, under another load case or
/// with another input.
struct VariedRun {
  std::string load_case;
  std::string input;  ///< that was changed; empty: none
  std::vector<Row> rows;
  std::string message;  ///< why there are none
};

/// What an input, or an alternative to one, does to a value.
struct InputShare {
  std::string input;
  std::optional<double> change;  ///< by its uncertainty, in the unit of the value; empty: unknown
  bool alternative = false;      ///< no uncertainty, but another choice
};

/// A simulated value S beside a measured one D, by ASME V&V 20: E = S - D beside u_val, all in one unit; uncertainties
/// are standard ones.
struct ValidatedValue : RunKey {
  std::string name, quantity, unit;
  std::string load_case;  ///< "102 g − own weight"
  bool fitted = false;    ///< an input was fitted to it: E says nothing
  double measured = 0, u_measured = 0;
  std::optional<double> simulated;  ///< the limit of the model's lattices
  std::optional<double> u_numerical;
  std::optional<double> u_input;
  std::optional<double> error;  ///< E
  std::optional<double> u_val;
  std::optional<double> ratio;       ///< |E| / u_val; empty: fitted, or not judged
  std::string not_judged;            ///< why not
  std::optional<double> springs;     ///< model - finite elements on the same cells, the finest that both have
  std::optional<double> resolution;  ///< finest lattice - limit
  std::vector<InputShare> inputs;
  std::string source, licence;
  std::string history;  ///< that it is a sample of; empty: none
  double time = 0;      ///< of the sample [s]
};

/// Results of the runs of a case, at one Poisson's ratio or at all of them.
struct Part {
  std::vector<Run> runs;
  std::vector<Row> rows;
  std::vector<ReferenceRecord> references;
  std::vector<Picture> pictures;
  std::vector<LineRecord> lines;
  std::vector<HistoryRecord> histories;
  std::vector<ErrorSplit> splits;
  std::vector<Deformation> deformations;
  std::vector<CrackRecord> cracks;
  std::vector<LatticeLimit> limits;
  std::vector<VariedRun> varied;
};

/// A part of the body by its material; the first is what is in no region.
struct RegionRecord {
  std::string name;                       ///< "": in no region
  std::string colour;                     ///< in the section
  std::vector<double> youngs_modulus_Pa;  ///< of each material that the case gives it, and its
  std::vector<double> poisson_ratio;
  double density_kg_m3 = 0;
  double volume_m3 = 0;
  std::vector<int> cells;  ///< of the springs, at each resolution; cut ones counted whole
};

/// What is known of a case once it is meshed.
struct MeshedCase {
  Vec3 size = Vec3::Zero();  ///< of the body [m]; for a body of voxels that of its bounding box
  std::vector<Cells> cells;  ///< of its lattices; of a body of voxels those of its bounding box
  std::map<std::string, double>
      own_poisson_ratios;                   ///< of the models, by label, that are solids of one Poisson's ratio only
  std::map<std::string, std::string> laws;  ///< of the models, by label, whose springs follow a law of finite strain:
                                            ///< its name among `kinematics`; none in linear cases
  std::map<std::string, std::string> made_of;  ///< of the models, by label: "springs", "a term per cell", ...
  std::vector<RegionRecord> regions;           ///< of a body of several materials
  std::string section_svg;                     ///< of the same, a plane section through them
  std::vector<std::string> notes;              ///< what was repaired or left out of the body
};

struct CaseResult : Part, MeshedCase {
  Experiment experiment;  ///< as read
  std::vector<Check> checks;
  std::vector<PublishedRow> published;
  std::vector<ValidatedValue> validation;
  std::string validated;  ///< what `validation` says, in sentences
};

/// {812, 0, 0} stands for 812 tetrahedra, which form no grid.
bool is_tetrahedra(const Cells& cells);

/// "10x10x10" or "812 tets".
std::string cells_text(const Cells& cells, std::string_view times = "x");

/// Number of hexahedra or tetrahedra; of a body of voxels that of its bounding box.
double cell_count(const Cells& cells);

/// Cell sizes of one grid over those of a finer one, in a sequence whose finest is divided along the axes on which it
/// has more than one cell.
double size_ratio(const Cells& coarse, const Cells& fine, const Cells& finest);

/// What to know before the errors of a case are read, one clause each: a body that its supports carry along; at large
/// strain loads, and models that follow another law than the reference.
std::vector<std::string> cautions(const CaseResult& result);

/// Turns every value that has a unit beside it into the units of its case.
void give_in_units_of_case(CaseResult& result);

/// A load as a sentence with units: "x_max: moved by (0.12, 0, 0) m".
std::string describe(const Load& load, Kinematics kinematics = Kinematics::linear, Units units = Units::m);

/// A mass likewise: "weight: 0.05 kg at (0.1, 0, 0.03) m".
std::string describe(const AttachedMass& mass, Units units = Units::m);

/// "12.5 mm", "(1, 2, 3) mm": what is given in a unit of SI, in that of the case.
std::string text(double quantity, Units units, const char* si = "m", int digits = 6);
std::string text(const Vec3& quantity, Units units, const char* si = "m", int digits = 6);

/// How a load is drawn.
struct LoadMark {
  std::string kind;            ///< "held", "moved", "turned", "force", "pressure", "gravity", "point"; empty: not drawn
  std::string on;              ///< patch; empty: the whole body, or the point `at`
  Vec3 vector = Vec3::Zero();  ///< displacement [m], axis times angle [rad], force [N], traction [Pa], acceleration
                               ///< [m/s^2]; of a pressure [Pa] its x
  Vec3 at = Vec3::Zero();      ///< of a point force, or a point of the axis [m]
};
LoadMark mark(const Load& load);

/// Everything but pictures; the schema is written out in docs/results.md.
/// Numbers that are not finite become null.
nlohmann::json to_json(const CaseResult& result);

/// {"case", "folder", "marks", "meshes", "pictures"}: surfaces of equal rest shape are stored once; arrays are base64
/// of little-endian numbers, displacements as 16-bit multiples of a scale (docs/results.md).
/// @throws std::invalid_argument if the arrays of a picture do not fit each other.
nlohmann::json pictures_to_json(const CaseResult& result);

/// A field of a CSV file: text quoted by RFC 4180 where needed; a number with as many digits as read back exactly,
/// empty if not finite.
std::string csv_text(const std::string& field);
std::string csv_number(const std::optional<double>& x);

/// results.csv: one line per row of every case, with the printed value ([[published]], and [[expect]] with source
/// "published") where there is one; then one line per printed value of something that has no row.
std::string to_csv(const std::vector<CaseResult>& results);

}  // namespace springproof
