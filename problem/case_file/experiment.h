// An experiment: body, material, loads, models, measures, published values, tolerances.  Read from TOML.
#pragma once

#include <algorithm>
#include <array>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "problem/attached_mass.h"
#include "problem/body.h"
#include "problem/case_file/units.h"
#include "problem/course.h"
#include "problem/fracture.h"
#include "problem/loads.h"
#include "problem/material.h"
#include "problem/model_choice.h"
#include "problem/patch_rule.h"
#include "problem/plane.h"
#include "problem/region.h"
#include "problem/relaxation.h"
#include "problem/system/input_error.h"

namespace springproof {

struct Probe {
  std::string name;
  Vec3 at = Vec3::Zero();  ///< rest position [m]
};

/// Plane on which the mean distance between two deformed states is measured (Golec et al. 2019, sec. 6.2).
struct Section {
  Vec3 point = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();
};

/// Line along which strain and stress are compared with Kelvin's solution (Kot et al. 2014, sec. 5.2).
struct Line {
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();  ///< [m]
  int points = 100;                             ///< point i of 1 ... points lies at from + (i / points) (to - from)
  std::array<int, 2> middle = {15, 80};  ///< first and last point of the range over which deviations are averaged
};

/// Position [m] of a point of the line, numbered from 1.
Vec3 point_of(const Line& line, int number);

/// How the finite element reference is computed.
struct ReferenceChoice {
  Cells cells = {0, 0, 0};  ///< finest of three grids; {0,0,0} = chosen from the body's cells
  std::vector<std::string> elements = {
      "q2"};             ///< each run on the three grids; the first is the reference; none: no reference
  double grading = 1.5;  ///< exponent that draws elements towards the faces of the block; 1 = uniform
  double edge = 0;       ///< [m] edge length of the tetrahedra for a body of voxels, finest of three meshes; 0 = chosen
  double refine = 1;     ///< so many times as many tetrahedra, cut where their error is largest
  bool in_time = false;  ///< the motion of [dynamics] is integrated by finite elements too
  bool energy_momentum = false;  ///< in time by energy-momentum steps; false: by the midpoint rule
  bool smooth = false;           ///< the exact solution is smooth: the elements' theoretical order may be assumed
};

/// Elements of the reference: hexahedra "q1", "q2", tetrahedra "p1", "p2".
std::vector<std::string> element_names();

/// Motion in time of the models ([dynamics]).
struct MotionChoice {
  std::string integrator = "explicit";  ///< semi-implicit Euler, Golec et al. (2019), sec. 3 and 6.1; the implicit
                                        ///< "energy_momentum", "implicit_euler"; "auto"
  bool released = false;                ///< start = "equilibrium": under the loads, which are then removed
  double duration = 0;                  ///< [s]
  std::optional<double>
      time_step;                 ///< [s]; empty: 0.95 of the bound of each model, implicit: a sample's, up to 10 of it
  double damping = 0;            ///< mass-proportional [1/s]
  double viscosity = 0;          ///< time of retardation of a Kelvin-Voigt solid [s]
  double mass_consistency = 0;   ///< share of consistent mass of the models, 0 to 1
  std::optional<Plane> plane;    ///< that the body may fall on
  Course course;                 ///< of the loads; of a released body's, how they are removed
  Vec3 velocity = Vec3::Zero();  ///< at the start, of the body as a whole [m/s]
  Vec3 spin = Vec3::Zero();      ///< and about its centre of mass [rad/s]
  bool equilibrium = true;       ///< each model is also solved for its equilibrium
  int samples = 200;             ///< of each history
  int frames = 40;               ///< of the animation; 0: none
  SourceLocation where;          ///< of time_step_s, or of the table
  SourceLocation integrator_where;  ///< of integrator, or of the table
  SourceLocation mass_where;        ///< of mass_consistency
};

enum class Source { analytic, extrapolated_fem, published, measured, regression };
std::string to_string(Source source);

/// An expected value of a measure; it decides the verdict of the case.
struct Expectation {
  std::string model;  ///< label of a model in [compare], "fem" (the extrapolated reference), or
                      ///< "fem_<element>": that element of [compare] at the models' resolutions, or the
                      ///< limit of that element of [reference]
  std::optional<double> poisson_ratio;  ///< empty: at every one
  std::optional<Cells> cells;           ///< empty: at every resolution
  std::string measure;                  ///< name of a measure, e.g. "volume_change", "force.z_max.magnitude"
  Source source = Source::extrapolated_fem;
  std::optional<double> value;     ///< empty: the extrapolated FEM value
  double within = 0;               ///< tolerance, absolute, in the measure's unit
  bool relative = false;           ///< `within_relative`: tolerance is a fraction of |value|
  std::optional<double> at_least;  ///< instead of value and tolerance: passes when computed >= at_least
  std::string where;               ///< "Table 3"
  SourceLocation location;
};

/// A published value shown beside ours, without influence on the verdict.
struct PublishedValue {
  std::string model;
  double poisson_ratio = 0;
  std::optional<Cells> cells;
  std::string measure;
  double value = 0;
  std::string where;   ///< "Table 3"
  std::string remark;  ///< why it cannot be reproduced, if so
  SourceLocation location;
};

/// Name of an entry of [[external]], displacements of another program, among Experiment::models: one for each file, so
/// of several Poisson's ratios several of one label.  Its file holds points and displacements (docs/engines.md);
/// options: "poisson_ratio", whose solid they are of; "scale", which turns the file's lengths into metres; "up_axis",
/// "y" or "z"; "force.PATCH.x", "..y", "..z": reactions [N]; "springs", false where they are no spring model's.
inline constexpr const char* external_model = "external displacements";

inline bool is_external(const ModelChoice& choice) { return choice.name == external_model; }

/// Whether the entry is a spring model of the user's own, to be named and ranked as one; false: finite elements or an
/// engine, brought for comparison only (springs = false).
inline bool is_own_model(const ModelChoice& choice) {
  const auto springs = choice.options.find("springs");
  return is_external(choice) && (springs == choice.options.end() || std::get<bool>(springs->second));
}

/// Follows the label of a model of cut cells in the name of its limit from two lattices.
inline constexpr const char* extrapolated_suffix = " extrapolated";

/// The part of the body whose moduli are a list, by which the results of a case are told apart.
struct ListedModuli {
  std::size_t region = 0;                    ///< its number; 0: what is in no region, by its Poisson's ratio
  bool stiffness = false;                    ///< by Young's modulus [Pa]; false: by Poisson's ratio
  std::vector<IsotropicMaterial> materials;  ///< of the region, in the file's order
};

/// A measured value.
struct MeasuredValue {
  std::string name;
  std::string quantity;     ///< a row of results: "mean_displacement.x_max.z", "frequency.z"
  Vec3 arm = Vec3::Zero();  ///< of a mean_displacement: from the middle of the patch to what was followed, which turns
                            ///< with the patch [m]
  std::size_t of = 0;       ///< number of its load case
  std::optional<std::size_t> minus = {};  ///< of the load case whose value is subtracted
  double value = 0, u = 0;   ///< with its standard uncertainty, in the unit of the quantity; NaN: not measured yet
  bool fitted = false;       ///< an input was fitted to it: it is no prediction
  std::string history = {};  ///< that it is a sample of; empty: none
  double time = 0;           ///< of the sample [s]
  std::string source = {}, licence = {};
  SourceLocation where = {};  ///< of its quantity
};

/// An input of a simulation that is not known exactly.
struct UncertainInput {
  enum class Kind {
    uncertain,   ///< by a standard uncertainty
    fitted,      ///< fitted to the measured value that says so
    alternative  ///< as good a choice, such as another law
  };
  std::string name;
  Kind kind = Kind::uncertain;
  SourceLocation where;
};

/// The case under other loads, or after another time under them; the first is the case as written.
struct LoadCase {
  std::string name;
  SourceLocation where;
  std::size_t table = 0;                  ///< number of its [[load_case]]
  std::optional<double> loaded_for = {};  ///< instead of the time of the case [s]
};

/// A case: one body, its loads, the materials and models it is run with, and the expected results.
struct Experiment {
  std::string name;    ///< the file's stem
  std::string folder;  ///< name of the folder that holds it, e.g. "golec_2019"
  std::filesystem::path file;
  std::string cite;
  std::string what;
  Units units = Units::m;             ///< in which it is written and its results are given; here all is in SI
  std::string kinematics = "linear";  ///< "linear", or a finite-strain law: "hencky", "log_cauchy", "neo_hooke",
                                      ///< "neo_hooke_isochoric", "st_venant_kirchhoff"
  Body body;
  std::vector<PatchRule> patches;            ///< defined by rules, in addition to those of the body itself
  std::vector<IsotropicMaterial> materials;  ///< in the file's order, each Poisson's ratio once
  Relaxation relaxation;                     ///< of each of them; their moduli are those at long times
  SourceLocation relaxation_where;           ///< of [material.relaxation]
  double loaded_for = std::numeric_limits<double>::infinity();  ///< of equilibria [s]
  std::vector<MaterialRegion> regions;                          ///< parts of the body that are of other materials
  ListedModuli listed;                                          ///< of a region, where its material is a list
  std::vector<Load> loads;
  std::vector<AttachedMass> masses;            ///< beside the body's own
  std::vector<SourceLocation> mass_locations;  ///< of each
  std::size_t weights = 0;                     ///< loads, the last of `loads`, that are the weight of `masses`
  std::vector<SourceLocation> load_locations;  ///< of the [[load]] that each of `loads` came from
  std::vector<ModelChoice> models;             ///< empty: the reference alone is verified
  std::vector<std::string> elements = {"q1"};  ///< finite elements compared beside the models, at the same resolutions
  double max_unknowns = 0;  ///< models and elements with more than about this many unknowns are not run; 0: no limit
  bool cost = false;        ///< run times are compared: short runs are repeated, all stop at the same residual
                            ///< (problem/system/run_cost.h)
  bool parts = false;  ///< of a body of voxels: by what each error is made, which takes finite elements on its cubes
                       ///< and on these cut into eight, the largest runs of the case
  std::string exact;   ///< name of the exact field that is the solution (problem/exact_field.h); empty: none
  std::vector<std::string> measures;
  std::vector<Probe> probes;
  std::optional<Section> section;
  std::optional<Line> line;
  std::optional<MotionChoice> dynamics;
  std::optional<Fracture> fracture;  ///< the models dry and break instead of being loaded
  ReferenceChoice reference;
  std::vector<Expectation> expectations;
  std::vector<PublishedValue> published;
  std::vector<LoadCase> load_cases;  ///< beside measured values: the first is the case as written
  std::vector<UncertainInput> inputs;
  std::vector<MeasuredValue> measured;           ///< that the first of `models` is judged by
  std::vector<std::filesystem::path> histories;  ///< files behind some of these
  std::vector<std::string> left_out;             ///< what was measured too, and is not compared
  std::string text;                              ///< the file as read

  bool asks_for(const std::string& measure) const { return std::ranges::count(measures, measure) > 0; }
  /// @return the solid of equilibria: a material of the case, relaxed for `loaded_for`
  IsotropicMaterial at_rest(const IsotropicMaterial& material) const;
  /// Values of the listed modulus, each once, in the file's order; records and files of results name it poisson_ratio.
  std::vector<double> settings() const;
  /// Its value for a material of what is in no region, in a case with one material of each region.
  double setting_of(const IsotropicMaterial& rest) const;
  /// The case with one material of each region: the list's of this number, counted as settings() are.
  Experiment at(std::size_t setting) const;
  /// Of a region, by its number, or of what is in none (0), all materials of the list if it has one.
  std::vector<IsotropicMaterial> materials_of_part(std::size_t region) const;
  /// The material of what is in no region at a setting.
  const IsotropicMaterial& body_material(std::size_t setting) const;
  /// Keeps the settings that are not `unwanted`.
  template <class Unwanted>
  void leave_out_settings(Unwanted unwanted) {
    std::erase_if(listed.region > 0 ? listed.materials : materials,
                  [&](const IsotropicMaterial& m) { return unwanted(listed_modulus(m)); });
    if (listed.region > 0 && !listed.materials.empty()) regions[listed.region - 1].material = listed.materials.front();
  }
  double listed_modulus(const IsotropicMaterial& m) const {
    return listed.stiffness ? m.youngs_modulus : m.poisson_ratio;
  }
  /// "ν", "ν of tumour", "E of tumour".
  std::string listed_symbol() const;
  /// "Poisson's ratio", "Poisson's ratio of tumour", "Young's modulus of tumour".
  std::string listed_words() const;
  Kinematics model_kinematics() const { return kinematics == "linear" ? Kinematics::linear : Kinematics::finite; }
};

/// Reads a case file.
/// @throws InputError with file, line, column, the key, what is allowed and the nearest known key.
Experiment read_experiment(const std::filesystem::path& file);

/// As read_experiment, from text; `file` is used for messages and relative paths.
Experiment parse_experiment(const std::string& text, const std::filesystem::path& file);

/// A rule by the keys of [[patch]], `side = "bottom"`; a word alone is a side.
/// @param source named by errors, e.g. "--hold"
/// @throws InputError as read_experiment
PatchRule parse_patch_rule(const std::string& name, const std::string& text, const std::string& source);

/// Kelvin's solution of the case's point force; empty unless there are exactly one point force and one material, and
/// the kinematics are linear.
std::optional<KelvinSolution> kelvin_of(const Experiment& experiment);

/// @param what names one of several things that know one material: "advise"
/// @throws InputError at the first [[region]], if the case has any.
void require_one_material(const Experiment& experiment, const std::string& what);

/// For what takes a case at one material of each region.
/// @throws InputError at a region whose material is a list of several.
void require_one_listed(const Experiment& experiment);

/// @throws InputError at the first load on a patch that is not among `patches`, those of the body.
void check_patches(const Experiment& experiment, const std::vector<std::string>& patches);

}  // namespace springproof
