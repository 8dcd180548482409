// The records as JSON, member by member under their own names: in results.json, and as CBOR in the files of finished
// parts.
#pragma once

#include <nlohmann/json.hpp>

#include "comparisons/results/records.h"
#include "problem/system/json.h"

namespace springproof {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Row, case_name, kinematics, model, poisson_ratio, cells, measure, of, value, unit,
                                   reference, reference_uncertainty, error, samples, spread)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Stability, load_reached, lost, strain, softest, alternation, wrinkles)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(LatticeLimit, model, poisson_ratio, imposed, free, held, wave, instead)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Run, model, kind, poisson_ratio, cells, kinematics, ok, message, solver, iterations,
                                   residual, seconds, unknowns, memory_MiB, set_up_seconds, stability, filled)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ReferenceRecord, poisson_ratio, measure, unit, cells, values, observed_order, value,
                                   uncertainty, note, element, converging, correlation)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Picture, model, poisson_ratio, cells, rest, displacement, difference, quads,
                                   volume_change, von_mises, frame_times, frames, surface, patches)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(LineRecord, model, poisson_ratio, cells, first, last, distance, strain, stress,
                                   exact_strain, exact_stress)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(HistoryRecord, model, poisson_ratio, cells, time_step, time, names, units, values,
                                   integrator, measured, probe)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ErrorSplit, model, poisson_ratio, cells, voxel_edge_m, measure, unit, total,
                                   model_error, discretisation_error, geometry_error, voxel_uncertainty, uncertainty,
                                   facets)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Deformation, poisson_ratio, principal_strain, rotation_deg, strained_share,
                                   applied_N, reacted_N)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(CrackRecord, model, poisson_ratio, cells, shrinkage, broken, fragments, stored,
                                   released, directions, svg)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PublishedRow, model, poisson_ratio, cells, measure, unit, published, computed, where,
                                   remark)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(VariedRun, load_case, input, rows, message)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(InputShare, input, change, alternative)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ValidatedValue, model, poisson_ratio, cells, name, quantity, unit, load_case, fitted,
                                   measured, u_measured, simulated, u_numerical, u_input, error, u_val, ratio,
                                   not_judged, springs, resolution, inputs, source, licence, history, time)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(RegionRecord, name, colour, youngs_modulus_Pa, poisson_ratio, density_kg_m3,
                                   volume_m3, cells)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(MeshedCase, size, cells, own_poisson_ratios, laws, made_of, regions, section_svg,
                                   notes)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Part, runs, rows, references, pictures, lines, histories, splits, deformations,
                                   cracks, limits, varied)

NLOHMANN_JSON_SERIALIZE_ENUM(Verdict, {{Verdict::pass, "pass"},
                                       {Verdict::fail, "fail"},
                                       {Verdict::reference_too_coarse, "reference too coarse"},
                                       {Verdict::no_reference, "no reference"},
                                       {Verdict::no_result, "no result"}})
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Check, model, poisson_ratio, cells, measure, unit, source, expected, computed,
                                   within, reference_uncertainty, verdict, where, at_least)

}  // namespace springproof
