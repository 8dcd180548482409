#include "problem/case_file/keys.h"

#include <fmt/format.h>

#include <stdexcept>

namespace springproof {
namespace {

constexpr const char* required = nullptr;
constexpr const char* a_vector = "[x, y, z], each a finite number";
constexpr const char* a_flag = "true or false";
constexpr const char* above_0 = "a finite number > 0";
constexpr const char* from_0 = "a finite number >= 0";

// clang-format off
constexpr Key file_keys[] = {
  {"what",       "what the case shows, a sentence",                 "a string",                                    "none", "\"A clamped bar.\""},
  {"cite",       "the paper that it is taken from",                 "a string",                                    "none", "\"Golec et al. (2019)\""},
  {"units",      "m: SI; mm: [mm, N, MPa, t, s](#units)",          "m, mm",                                       "m",    "\"m\""},
  {"kinematics", "small displacements, or the law of large strain", "linear, hencky, log_cauchy, neo_hooke, neo_hooke_isochoric, st_venant_kirchhoff", "linear", "\"hencky\""},
  {"body",       "the body and its lattices",                       "a table [body] with geo, size_m, cells",      required, ""},
  {"patch",      "parts of its surface",                            "tables headed [[patch]]",                     "those of the body", ""},
  {"material",   "elastic moduli and density",                      "a table [material] with two moduli",          required, ""},
  {"region",     "parts of the body of other materials",            "tables headed [[region]]",                    "one material", ""},
  {"load",       "supports and loads",                              "tables headed [[load]]",                      "required, but beside [dynamics]", ""},
  {"mass",       "masses hung on the body or glued to it",          "tables headed [[mass]]",                      "none", ""},
  {"compare",    "models and measures",                             "a table",                                     "hybmss, with three measures", ""},
  {"external",   "displacements that another program computed",     "tables headed [[external]]",                  "none", ""},
  {"section",    "a plane on which two deformed states are compared", "a table",                                   "none", ""},
  {"line",       "a line along which Kelvin's solution is known",   "a table",                                     "none", ""},
  {"dynamics",   "the models move in time",                         "a table",                                     "equilibria alone", ""},
  {"fracture",   "the models dry and crack",                        "a table",                                     "none", ""},
  {"probe",      "points whose displacement is compared",           "tables headed [[probe]]",                     "none", ""},
  {"reference",  "how finite elements compute the reference",       "a table",                                     "three grids of q2, of voxels p2", ""},
  {"expect",     "values that decide the exit status",              "tables headed [[expect]]",                    "none", ""},
  {"published",  "values printed beside ours",                      "tables headed [[published]]",                 "none", ""},
  {"measured",   "what was measured of the body",                   "tables headed [[measured]]",                  "none", ""},
  {"load_case",  "loads under which it was measured",               "tables headed [[load_case]]",                 "the case as written", ""},
  {"input",      "inputs that are uncertain",                       "tables headed [[input]]",                     "none", ""},
  {"identify",   "what measured values tell",                       "tables headed [[identify]]",                  "none", ""},
};

constexpr Key body_keys[] = {
  {"geo",          "a built-in body, or a file beside the case", "the name of a gmsh script, e.g. \"block.geo\", or of an .stl, .obj, .ply, .msh, .step or .brep file", required, "\"beam.geo\""},
  {"size_m",       "size_x, size_y, size_z of a script",         "[x, y, z], each a finite number > 0, from 1e-6 to 1e9 [m]", "required by scripts", "[0.06, 0.01, 0.01]"},
  {"scale",        "multiplies the coordinates of any other file", above_0,                                          "1",               "0.001"},
  {"cells",        "cells of a body of hexahedra; several: resolutions", "[nx, ny, nz] or a list of such, integers from 1 to 1000", "one of the three", "[[12, 2, 2], [24, 4, 4]]"},
  {"voxels",       "about so many cells, cut out along the surface of any body", "a whole number from 1 to 4e6, or a list of such", "one of the three", "[1500, 5000]"},
  {"voxel_edge_m", "edge of such cells",                         "a finite number > 0, or a list of such",           "one of the three", "[0.01, 0.005]"},
  {"cut",          "with voxels; false: whole cubes whose centres lie in the body", a_flag,                          "true, for models that take cut cells", "false"},
  {"accuracy",     "with one voxels or voxel_edge_m: cells are halved until this error is promised", "a number from 0.001 to 0.5, or a list of such", "cells of one size", "0.05"},
  {"coarsened",    "with voxels; true: cut cells are measured in a lattice three times as fine", a_flag, "false", "true"},
};

constexpr Key patch_keys[] = {
  {"name",   "its name, for `on`",                             "a name",                                  required,       "\"wrist\""},
  {"side",   "the plane face on that side of the body, or the outer twentieth of a round side: -x, x, -y, y, -z, z", "left, right, front, back, bottom, top", "no condition", "\"bottom\""},
  {"box_m",  "inside the box of two corners, the lower first", "two corners, [[x, y, z], [x, y, z]]",     "no condition", "[[0, 0, 0], [0.1, 0.1, 0.02]]"},
  {"beyond", "on one side of a plane",                         "a table",                                 "no condition", ""},
  {"facing", "whose outward normals are within an angle",      "a table",                                 "no condition", ""},
  {"near",   "the connected surface nearest to a point",       "a table",                                 "no condition", ""},
};

constexpr Key beyond_keys[] = {
  {"point_m", "a point of the plane",                 a_vector, required, "[0, 0, 0.01]"},
  {"normal",  "points to the facets that are meant",  a_vector, required, "[0, 0, -1]"},
};

constexpr Key facing_keys[] = {
  {"direction",  "compared with the outward normals", a_vector,                   required, "[0, 0, -1]"},
  {"within_deg", "the angle to it",                   "an angle > 0 and <= 180",  required, "30"},
};

constexpr Key near_keys[] = {
  {"point_m",  "to which the surface is the nearest", a_vector, required, "[0.05, 0.05, 0]"},
  {"radius_m", "up to this distance",                 above_0,  required, "0.03"},
};

constexpr Key material_keys[] = {
  {"youngs_modulus_Pa", "Young's modulus",        "a finite number > 0, or a list of such",      "two moduli", "1e6"},
  {"poisson_ratio",     "Poisson's ratio",        "-1 < poisson_ratio < 0.5, or a list of such", "two moduli", "[0.25, 0.45, 0.49]"},
  {"shear_modulus_Pa",  "shear modulus",          "a finite number > 0, or a list of such",      "two moduli", "4e5"},
  {"bulk_modulus_Pa",   "bulk modulus",           "a finite number > 0, or a list of such",      "two moduli", "1e6"},
  {"lame_lambda_Pa",    "Lame's first parameter", "a finite number, or a list of such",          "two moduli", "4e5"},
  {"density_kg_m3",     "density",                above_0,                                       "1000; required by gravity", "1100"},
  {"relaxation",        "Maxwell elements beside these moduli", "a table",                                       "none", ""},
};

constexpr Key relaxation_keys[] = {
  {"branches", "the elements ([motion](motion.md#springs-that-relax))", "a list of up to 8 { share, time_s }", required, "[{ share = 0.116, time_s = 0.27 }, { share = 0.057, time_s = 2.6 }]"},
  {"equilibrium_after_s", "of equilibria, under their loads; without [dynamics]", above_0, "for ever", "4"},
};

constexpr Key branch_keys[] = {
  {"share",  "of the long-time shear modulus", "a number from 1e-6 to 1000",  required, "0.116"},
  {"time_s", "in which its stress falls to 1/e",           "a finite number > 0, its own", required, "0.27"},
};

constexpr Key region_keys[] = {
  {"name",              "its name",                                  "a name",                               required,          "\"tumour\""},
  {"volume",            "a physical volume of the body's file, or a solid by number", "a string",          "a place",     "\"tumour\""},
  {"box_m",             "a box",                                     "two corners, [[x, y, z], [x, y, z]]",  "a place",     "[[0, 0, 0], [0.1, 0.1, 0.02]]"},
  {"near",              "a ball",                                    "a table",                              "a place",     "{ point_m = [0.05, 0.05, 0], radius_m = 0.03 }"},
  {"beyond",            "one side of a plane",                       "a table",                              "a place",     "{ point_m = [0, 0, 0.01], normal = [0, 0, -1] }"},
  {"stl",               "a closed surface: .stl, .obj, .ply",        "a string",                             "a place",     "\"tumour.stl\""},
  {"scale",             "multiplies its coordinates",                above_0,                                "the body's",  "0.001"},
  {"youngs_modulus_Pa", "as of [material]", "a finite number > 0, or a list of such",             "two moduli",      "1e6"},
  {"poisson_ratio",     "",                                          "-1 < poisson_ratio < 0.5, or a list of such","two moduli",      "[0.3, 0.45]"},
  {"shear_modulus_Pa",  "",                                          "a finite number > 0, or a list of such","two moduli",      "4e5"},
  {"bulk_modulus_Pa",   "",                                          "a finite number > 0, or a list of such","two moduli",      "1e6"},
  {"lame_lambda_Pa",    "",                                          "a finite number, or a list of such","two moduli",      "4e5"},
  {"density_kg_m3",     "",                                          above_0,                                "the body's",      "1100"},
};

constexpr Key on = {"on", "where it acts", "a patch name or a list of them", required, "\"x_min\""};

constexpr Key displacement_keys[] = {on,
  {"displacement_m", "of every point", "[x, y, z], each a finite number or \"free\"", required, "[0, \"free\", 0]"},
};
constexpr Key affine_keys[] = {on,
  {"displacement_gradient", "H of u = H X + displacement_m", "3 rows of 3 finite numbers", required, "[[0.1, 0, 0], [0, 0, 0], [0, 0, 0]]"},
  {"displacement_m",        "at the origin",                 a_vector,                     "0",      "[0, 0, 0.001]"},
};
constexpr Key rotation_keys[] = {on,
  {"rotation_deg", "the angle",           "a finite number", required, "30"},
  {"axis",         "its direction",       a_vector,          required, "[1, 0, 0]"},
  {"about_m",      "a point of the axis", a_vector,          required, "[0, 0.005, 0.005]"},
};
constexpr Key field_keys[] = {on,
  {"field", "an exact field, or \"kelvin\": of the case's point force in an infinite solid", "the name of an exact field", required, "\"trigonometric\""},
};
constexpr Key traction_keys[] = {on, {"traction_Pa", "per area at rest, in a direction that stays", a_vector, required, "[0, 0, -100]"}};
constexpr Key pressure_keys[] = {on, {"pressure_Pa", "per area at rest, against the outward normal at rest", "a finite number", required, "100"}};
constexpr Key patch_force_keys[] = {on, {"force_N", "in total, spread evenly", a_vector, required, "[0, 0, -0.005]"}};
constexpr Key point_force_keys[] = {
  {"force_N", "at a point",      a_vector, required, "[0, 0, -1]"},
  {"at_m",    "a rest position", a_vector, required, "[0.03, 0.005, 0.005]"},
};
constexpr Key gravity_keys[] = {{"gravity_m_s2", "acceleration of the whole body", a_vector, required, "[0, 0, -9.81]"}};
constexpr Key body_force_keys[] = {{"body_force_of", "that keeps this exact field in equilibrium; finite elements alone", "the name of an exact field", required, "\"trigonometric\""}};

constexpr Key compare_keys[] = {
  {"models",       "rows of `springproof list`, with options ([models](models.md)), a `label`; or springs files", "a list of model names and { model = \"...\" } tables", "[\"hybmss\"]", "[\"hybmss_avg\", { model = \"hybmss\", face_to_cube = 1 }, \"msm_18\"]"},
  {"measures",     "what is compared, of `springproof list`",                  "a list of measures",                  "displacement_error, volume_change, reaction", "[\"displacement_error\", \"reaction\"]"},
  {"elements",     "finite elements run beside the models on their cells",     "a list of elements: q1, q2, p1, p2",  "[\"q1\"] up to 20000 cells, else none", "[\"q1\", \"q2\"]"},
  {"max_unknowns", "larger runs are left out",                                 above_0,                               "no limit", "1e5"},
  {"cost",         "every error against time, unknowns and memory; short runs are repeated", a_flag,                  "false",    "true"},
  {"parts",        "of voxels: the parts of each error, of springs, resolution, staircase", a_flag,                   "false",    "true"},
  {"exact",        "the exact field that is the solution; with models = []",   "the name of an exact field",          "none",     "\"trigonometric\""},
};

constexpr Key external_keys[] = {
  {"name",          "label of its results",                                   "a name for its results",                                            required,      "\"abaqus\""},
  {"file",          "points and displacements, beside the case",              "the name of a CSV file of points and displacements",                "files",       "\"abaqus.csv\""},
  {"files",         "a file for each Poisson's ratio, with its keys",         "a list of { poisson_ratio = 0.3, file = \"...\" }",                 "file",        "[{ poisson_ratio = 0.25, file = \"abaqus.csv\" }]"},
  {"poisson_ratio", "of the solid that was computed",                         "a finite number, one of the case's",                                "the case's, if it has one", "0.25"},
  {"scale",         "multiplies coordinates and displacements",               above_0,                                                             "1",           "0.001"},
  {"up_axis",       "which axis of the file is the case's z",                 "y, z",                                                              "z",           "\"y\""},
  {"springs",       "its results are of springs, ranked among the models",    a_flag,                                                              "true",        "false"},
  {"reaction_N",    "forces of supports on the body",                         "{ x_min = [x, y, z] }, the force of each support on the body [N]",  "not compared", "{ x_min = [0, 0, 0.005] }"},
};

constexpr Key external_file_keys[] = {
  {"file",          "points and displacements",       "the name of a CSV file of points and displacements",               required,                    "\"abaqus.csv\""},
  {"poisson_ratio", "of the solid that was computed", "a finite number, one of the case's",                               "the case's, if it has one", "0.25"},
  {"reaction_N",    "forces of supports on the body", "{ x_min = [x, y, z] }, the force of each support on the body [N]", "not compared",              "{ x_min = [0, 0, 0.005] }"},
};

constexpr Key section_keys[] = {
  {"point_m", "a point of the plane", a_vector, required, "[0.03, 0, 0]"},
  {"normal",  "its normal",           a_vector, required, "[1, 0, 0]"},
};

constexpr Key line_keys[] = {
  {"from_m", "its first end, no point of comparison", a_vector,                            required,     "[0.03, 0.005, 0.005]"},
  {"to_m",   "its last point",                        a_vector,                            required,     "[0.06, 0.005, 0.005]"},
  {"points", "evenly spaced",                         "an integer from 2 to 10000",        "100",        "50"},
  {"middle", "points over which deviations are averaged", "[first, last], numbers of points", "15 to 80 % of them", "[8, 40]"},
};

constexpr Key dynamics_keys[] = {
  {"duration_s",       "of the motion",                                           above_0,                                         required,   "10"},
  {"integrator",       "of the models' steps",                                    "explicit, energy_momentum, implicit_euler, auto", "explicit", "\"auto\""},
  {"start",            "equilibrium: from that under the loads, which are then removed", "rest, equilibrium",                      "rest",     "\"equilibrium\""},
  {"time_step_s",      "of the models",                                           "a finite number > 0, up to duration_s",         "safe; implicit: that of the samples, up to 10 safe ones", "1e-3"},
  {"damping_1_s",      "Rayleigh's damping, of the mass",                         from_0,                                          "0",        "0.5"},
  {"viscosity_s",      "Rayleigh's damping, of the strain",                       from_0,                                          "0",        "1e-3"},
  {"loss_factor",      "of the material at both ends of band_Hz, instead of the two", "a finite number >= 0, up to 1",              "0",        "0.1"},
  {"band_Hz",          "with loss_factor, the lower frequency first",             "two frequencies [Hz]",                          "none",     "[1, 3]"},
  {"mass_consistency", "share of consistent mass of explicit steps ([motion](motion.md))", "a share of consistent mass, 0 to 1",   "0: corner masses", "0.5"},
  {"ramp_s",           "loads grow linearly over this time",                      "a finite number >= 0, up to duration_s",        "0, at once", "2"},
  {"pulse_s",          "instead: loads last for this time, as half a sine wave",  "a finite number > 0, up to duration_s",         "none",     "0.01"},
  {"shake_Hz",         "instead: loads and moved supports are a sine wave",       above_0,                                         "none",     "3"},
  {"plane",            "which the body may fall on; of models alone",             "a table",                                       "none",     ""},
  {"velocity_m_s",     "of the whole body at the start",                          a_vector,                                        "0",        "[0, 0, -1]"},
  {"spin_rad_s",       "about its centre of mass at the start",                   a_vector,                                        "0",        "[0, 0, 20]"},
  {"equilibrium",      "each model is also solved for its equilibrium",           a_flag,                                          "true",     "false"},
  {"samples",          "of each history",                                         "an integer from 2 to 100000",                   "200",      "400"},
  {"frames",           "of the animation",                                        "an integer from 0 to 1000",                     "40",       "80"},
};

constexpr Key plane_keys[] = {
  {"point_m",  "a point of the plane",                                a_vector, required, "[0, 0, -0.1]"},
  {"normal",   "towards the body",                                    a_vector, required, "[0, 0, 1]"},
  {"friction", "Coulomb's coefficient, of integrator explicit and auto", from_0, "0",     "0.3"},
};

constexpr Key fracture_keys[] = {
  {"shrinkage", "of the rest lengths at the top at the end",            "a number from 0 to 0.5",            required,               "0.1"},
  {"threshold", "the mean stretch at which springs break",              "a number > 0, up to 1",             required,               "0.02"},
  {"steps",     "from rest to that shrinkage",                          "a whole number from 1 to 100000",   "100",                  "200"},
  {"depth_m",   "below the top at which the shrinkage has fallen to 1/e", above_0,                           "the same everywhere",  "0.01"},
  {"scatter",   "relative standard deviation of the thresholds",        "a number from 0 to 0.5",            "0",                    "0.1"},
  {"apart",     "springs farther apart, in mean spring lengths, break together", from_0,                     "5",                    "3"},
  {"seed",      "of the first sample",                                  "a whole number from 1 to 1e+09",    "1",                    "7"},
  {"seeds",     "number of samples",                                    "a whole number from 1 to 1000",     "1",                    "5"},
};

constexpr Key mass_keys[] = {
  {"name",    "its name",                                         "a name",                                              required,              "\"weight\""},
  {"at_m",    "a point of the body, or the ends of a segment", "[x, y, z], or two such",         "one of the two", "[[0.1, 0, 0.03], [0.1, 0.03, 0.03]]"},
  {"on",      "a patch that it is spread over",                   "the name of a patch",                                 "one of the two", "\"x_max\""},
  {"mass_kg", "mass",                                             above_0,                                               required,              "0.052"},
  {"weighs",  "false: gravity does not act on it", a_flag,                                                "true",                "false"},
};

constexpr Key probe_keys[] = {
  {"name", "part of the names of its rows", "a name",  required, "\"tip\""},
  {"at_m", "a rest position",               a_vector,  required, "[0.06, 0.005, 0.005]"},
};

constexpr Key reference_keys[] = {
  {"cells",      "of the finest of three grids, of hexahedra",               "[nx, ny, nz], integers from 1 to 1000", "from those of the body", "[48, 8, 8]"},
  {"elements",   "each on three grids or meshes; the first is the reference; []: none", "a list of elements: q1, q2, p1, p2", "[\"q2\"]; of voxels [\"p2\"]", "[\"q2\", \"q1\"]"},
  {"grading",    "draws elements towards the faces of a block; 1: even",     "a number from 1 to 3",                  "1.5; 1 beside [[patch]]", "1"},
  {"edge_m",     "of the tetrahedra of the finest of three meshes, of voxels", above_0,                               "from the body", "0.01"},
  {"refine",     "so many times as many tetrahedra, cut where they err; of equilibria", "a number from 1 to 10", "1", "3"},
  {"smooth",     "the solution is smooth: the elements' order in theory is assumed", a_flag,                          "false",  "true"},
  {"in_time",    "finite elements move too, minutes for each Poisson's ratio; with [dynamics] and [[probe]]",  a_flag,                                  "false",  "true"},
  {"integrator", "of their steps, with in_time",                             "midpoint, energy_momentum",             "midpoint", "\"energy_momentum\""},
};

constexpr Key expect_keys[] = {
  {"model",           "whose value is judged",                          "a model of [compare], or fem, fem_q1, ...",          required,               "\"hybmss\""},
  {"measure",         "a name of results.csv",                          "the name of a row",                                  required,               "\"displacement_error\""},
  {"source",          "where the expected value is from",               "analytic, extrapolated FEM, published, measured, regression",  required,               "\"analytic\""},
  {"poisson_ratio",   "at which it is judged, or the E listed", "a finite number, one of the case's",           "at each", "0.25"},
  {"cells",           "at which it is judged",                          "[nx, ny, nz], integers from 1 to 1000",              "at each", "[12, 2, 2]"},
  {"value",           "the expected value, in the unit of the measure", "a finite number",                                    "the reference's, of extrapolated FEM", "0"},
  {"within",          "tolerance, in the same unit",          from_0,                                               "one of the three", "0.04"},
  {"within_relative", "tolerance, as a part of the value",              from_0,                                               "one of the three", "0.01"},
  {"at_least",        "no value: what it must reach",                   "a finite number",                                    "one of the three", "0.9"},
  {"where",           "of the source",                                  "a string",                                           "none",                 "\"Table 3\""},
};

constexpr Key published_keys[] = {
  {"model",         "a name, of the report",                  "the name of a model",                   required,  "\"hybmss\""},
  {"poisson_ratio", "at which it was computed",               "a finite number, one of the case's",  required,  "0.25"},
  {"measure",       "a name of results.csv",                  "the name of a row",                     required,  "\"displacement_error\""},
  {"value",         "as printed",                             "a finite number",                       required,  "0.031"},
  {"where",         "where it is printed",                    "table or figure",                       required,  "\"Table 3\""},
  {"cells",         "with which it was computed",             "[nx, ny, nz], integers from 1 to 1000", "none",    "[10, 10, 10]"},
  {"remark",        "why ours differs",                       "a string",                              "none",    "\"The reference was coarser.\""},
};

constexpr Key measured_keys[] = {
  {"source",   "where the values are from",                      "a string",                                                  required, "\"our laboratory, 3 May 2026\""},
  {"licence",  "under which they may be used",                   "a string",                                                  required, "\"CC BY 4.0\""},
  {"values",   "the values",                                     "a list of { name, quantity, value, u }",                    "histories", ""},
  {"histories", "values in time, each of an equilibrium after it; keys of values too", "a list of { name, quantity, file }",                       "none", ""},
  {"left_out", "measured too, and not compared",     "a string",                                                  "none",   "\"creep\""},
};

constexpr Key measured_value_keys[] = {
  {"name",      "of its row, measured.NAME",                             "a name",                                    required, "\"sag\""},
  {"quantity",  "what was measured: a name of results.csv",                       "the name of a row",                         required, "\"displacement.tip.z\""},
  {"value",     "in its unit",                                                    "a finite number",                           "not measured yet", "-0.0108"},
  {"u",         "its standard uncertainty",                                       above_0,                                     "with `value`", "3e-4"},
  {"arm_m",     "of a mean_displacement: from the middle of the patch to the marker", a_vector,       "0",      "[0, 0, 0.007]"},
  {"load_case", "under which loads",                                              "the name of a [[load_case]]",               "the first", "\"52 g\""},
  {"minus",     "whose value is subtracted",                                      "the name of a [[load_case]]",               "none",   "\"own weight\""},
  {"use",       "fit: an input was fitted to it",                                 "fit, predict",                              "predict", "\"fit\""},
};

constexpr Key measured_history_keys[] = {
  {"name",      "of its row, measured.NAME",           "a name",                       required,    "\"creep\""},
  {"quantity",  "what was measured: a name of results.csv", "the name of a row",       required,    "\"displacement.tip.z\""},
  {"file",      "its columns: time_s,value_m,u_m",     "a name of a file, .csv",       required,    "\"creep.csv\""},
  {"arm_m",     "of a mean_displacement: from the middle of the patch to the marker", a_vector, "0", "[0, 0, 0.007]"},
  {"load_case", "under which loads",                   "the name of a [[load_case]]",  "the first", "\"52 g\""},
  {"from_end",  "the last sample is subtracted",       a_flag,                         "false",     "true"},
};

constexpr Key load_case_keys[] = {
  {"name", "its name",                                          "a name",                                     required,                   "\"own weight\""},
  {"with", "what is changed; [] leaves out", "keys of the case with other values",         "none, of the first alone", "{ mass = [] }"},
};

constexpr Key input_keys[] = {
  {"name",   "its name",                                             "a name",                                      required,         "\"thickness\""},
  {"of",     "the number, or several that change together",          "a key as written here, body.size_m[2], or a list of such", "with `u`", "\"body.size_m[2]\""},
  {"u",      "its standard uncertainty, up or down",                 "a finite number",                             "with `of`",      "3e-4"},
  {"with",   "instead: a choice that is as good",                    "keys of the case with other values",          "none",           "{ kinematics = \"neo_hooke\" }"},
  {"fitted", "it was fitted to the value with use = \"fit\"",        a_flag,                                        "false",          "true"},
};

constexpr Key identify_keys[] = {
  {"name",       "its name",                       "a name",                                required,                    "\"modulus\""},
  {"parameters", "what is sought",                 "a list of { of, start, bounds }",       required,                    "[{ of = \"material.youngs_modulus_Pa\" }]"},
  {"fit",        "fitted; all others are predicted", "a list of names of measured values", "those with use = \"fit\"", "[\"sag\"]"},
  {"model",      "by which",                       "a model of the case, or fem_q1, fem_q2, fem_p1, fem_p2", "the first", "\"fem_p1\""},
  {"cells",      "of its lattices",                "a list of [nx, ny, nz]",                "those of the case",         "[[20, 6, 6]]"},
};

constexpr Key identify_parameter_keys[] = {
  {"of",     "the number, or several that are one", "a key as written here, material.youngs_modulus_Pa, or a list of such", required, "\"material.youngs_modulus_Pa\""},
  {"start",  "from where it is sought",             "a finite number",                                     "as written",     "1e5"},
  {"bounds", "between which",                       "two numbers, the lower first",                        "of a material: wide ones", "[1e4, 1e7]"},
};

constexpr KeyTable tables[] = {
  {"",                           "The file",                         "Every table of a case.",                                      file_keys},
  {"body",                       "[body]",                           "",                                                            body_keys},
  {"patch",                      "[[patch]]",                        "A part of the surface, where all its conditions hold. Facets of a body of voxels are cut along its border (with `facing`, taken whole); of hexahedra the border must run along lines of every grid, those of the reference too (its finest cells, half and a quarter). A box that reaches below the edge of a face also takes that strip of its sides.", patch_keys},
  {"patch.beyond",               "",                                 "",                                                            beyond_keys},
  {"patch.facing",               "",                                 "",                                                            facing_keys},
  {"patch.near",                 "",                                 "",                                                            near_keys},
  {"material",                   "[material]",                       "Two moduli. A single number goes with each of a list; two lists are read in pairs. Of one material in the file moduli may be lists.", material_keys},
  {"material.relaxation",        "",                                 "",                                                            relaxation_keys},
  {"material.relaxation.branches", "",                               "",                                                            branch_keys},
  {"region",                     "[[region]]",                       "A part of the body of another material; where two overlap, the later one. By finite elements, hybmss_avg in cut cells, lattices without momentum dispersion in whole cubes.", region_keys},
  {"load.displacement_m",        "a displacement",                   "",                                                            displacement_keys},
  {"load.displacement_gradient", "an affine displacement",           "",                                                            affine_keys},
  {"load.rotation_deg",          "a rotation",                       "",                                                            rotation_keys},
  {"load.field",                 "an exact displacement",            "",                                                            field_keys},
  {"load.traction_Pa",           "a traction",                       "",                                                            traction_keys},
  {"load.pressure_Pa",           "a pressure",                       "",                                                            pressure_keys},
  {"load.force_N",               "a force on a patch",               "",                                                            patch_force_keys},
  {"load.at_m",                  "a force at a point",               "",                                                            point_force_keys},
  {"load.gravity_m_s2",          "gravity",                          "",                                                            gravity_keys},
  {"load.body_force_of",         "the force of an exact field",          "Under kinematics = \"linear\", with models = [].",        body_force_keys},
  {"mass",                       "[[mass]]",                         "Inertia and, under gravity, weight beside the body's own.", mass_keys},
  {"compare",                    "[compare]",                        "",                                                            compare_keys},
  {"reference",                  "[reference]",                      "",                                                            reference_keys},
  {"probe",                      "[[probe]]",                        "",                                                            probe_keys},
  {"section",                    "[section]",                        "",                                                            section_keys},
  {"line",                       "[line]",                           "In a case of one material and one point force, under kinematics = \"linear\".", line_keys},
  {"expect",                     "[[expect]]",                       "",                                                            expect_keys},
  {"published",                  "[[published]]",                    "",                                                            published_keys},
  {"measured",                   "[[measured]]",                     "Values of the body itself, with standard uncertainties; the first model is judged by them (`measured.NAME` = \\|E\\|/u_val).", measured_keys},
  {"measured.values",            "",                                 "",                                                            measured_value_keys},
  {"measured.histories",         "",                                 "",                                                            measured_history_keys},
  {"load_case",                  "[[load_case]]",                    "",                                                            load_case_keys},
  {"input",                      "[[input]]",                        "The first model runs once with each in every load case, on its coarsest lattice.", input_keys},
  {"identify",                   "[[identify]]",                     "For `springproof identify`.",                                 identify_keys},
  {"identify.parameters",        "",                                 "",                                                            identify_parameter_keys},
  {"external",                   "[[external]]",                     "Displacements by any program ([engines](engines.md#any-program-beside-the-models)).", external_keys},
  {"external.files",             "",                                 "",                                                            external_file_keys},
  {"dynamics",                   "[dynamics]",                       "Under any kinematics but \"linear\" ([motion](motion.md)). Each model is computed twice: its equilibrium, and its state after `duration_s`, labelled `NAME in motion`.",  dynamics_keys},
  {"dynamics.plane",             "",                                 "",                                                            plane_keys},
  {"fracture",                   "[fracture]",                       "Under kinematics = \"linear\", on supports at rest ([fracture](fracture.md)).", fracture_keys},
};

// clang-format on

}  // namespace

std::span<const KeyTable> key_tables() { return tables; }

std::span<const Key> keys_of(std::string_view table) {
  for (const KeyTable& t : tables)
    if (t.name == table) return t.keys;
  throw std::logic_error(fmt::format("case files have no table '{}'", table));
}

}  // namespace springproof
