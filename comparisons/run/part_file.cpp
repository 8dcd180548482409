#include "comparisons/run/part_file.h"

#include <nlohmann/json.hpp>
#include <string_view>

#include "problem/system/json.h"

namespace springproof {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Row, case_name, kinematics, model, poisson_ratio, cells, measure, value, unit,
                                   reference, reference_uncertainty, error, samples, spread)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Stability, load_reached, lost, strain, softest, alternation, wrinkles)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(LatticeLimit, model, poisson_ratio, imposed, free, held, wave, instead)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Run, model, kind, poisson_ratio, cells, kinematics, ok, message, solver, iterations,
                                   residual, seconds, unknowns, memory_MiB, set_up_seconds, stability)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ReferenceRecord, poisson_ratio, measure, unit, cells, values, observed_order, value,
                                   uncertainty, note, element, converging, correlation)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Picture, model, poisson_ratio, cells, rest, displacement, difference, quads,
                                   volume_change, frame_times, frames, surface, patches)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(LineRecord, model, poisson_ratio, cells, first, last, distance, strain, stress,
                                   exact_strain, exact_stress)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(HistoryRecord, model, poisson_ratio, cells, time_step, time, names, units, values,
                                   integrator, measured, probe)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ErrorSplit, model, poisson_ratio, cells, voxel_edge, measure, unit, total,
                                   model_error, discretisation_error, geometry_error, voxel_uncertainty,
                                   body_uncertainty)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Deformation, poisson_ratio, principal_strain, rotation_deg)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(CrackRecord, model, poisson_ratio, cells, shrinkage, broken, fragments, stored,
                                   released, directions, svg)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Part, runs, rows, references, pictures, lines, histories, splits, deformations,
                                   cracks, limits)

// File format: this heading (comparisons/run/checked_file.h), then the stamp and the part.
static constexpr std::string_view heading = "springproof part 2 ";

void save_part(const std::filesystem::path& file, const std::string& stamp, const Part& part) {
  write_checked(file, heading, {{"stamp", stamp}, {"part", part}});
}

std::optional<Part> load_part(const std::filesystem::path& file, const std::string& stamp) try {
  if (!std::filesystem::exists(file)) return {};
  const nlohmann::json document = read_checked(file, heading);
  if (document.at("stamp") != stamp) return {};
  return document.at("part").get<Part>();
} catch (const nlohmann::json::exception&) {
  refuse_damaged(file);
}

}  // namespace springproof
