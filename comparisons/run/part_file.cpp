#include "comparisons/run/part_file.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string_view>

#include "comparisons/run/checksum.h"
#include "problem/system/child.h"
#include "problem/system/files.h"
#include "problem/system/json.h"

namespace springproof {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Row, case_name, kinematics, model, poisson_ratio, cells, measure, value, unit,
                                   reference, reference_uncertainty, error, samples, spread)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Run, model, kind, poisson_ratio, cells, kinematics, ok, message, solver, iterations,
                                   residual, seconds, unknowns, memory_MiB, set_up_seconds)
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
                                   cracks)

namespace {

// File format: this line with the checksum of the rest appended, then the rest as CBOR.
constexpr std::string_view heading = "springproof part 1 ";

[[noreturn]] void damaged(const std::filesystem::path& file) {
  throw DamagedPart(fmt::format("{} is damaged", file.string()));
}

/// The body after the heading, if the heading's checksum matches it.
std::string_view checked(const std::filesystem::path& file, std::string_view bytes) {
  const std::size_t end = bytes.find('\n');
  if (end == std::string_view::npos || !bytes.starts_with(heading)) damaged(file);
  const std::string_view body = bytes.substr(end + 1);
  if (bytes.substr(heading.size(), end - heading.size()) != checksum(body)) damaged(file);
  return body;
}

}  // namespace

void save_part(const std::filesystem::path& file, const std::string& stamp, const Part& part) {
  std::string body;
  nlohmann::json::to_cbor({{"stamp", stamp}, {"part", part}}, body);
  write_file(file, fmt::format("{}{}\n", heading, checksum(body)) + body);
}

std::optional<Part> load_part(const std::filesystem::path& file, const std::string& stamp) {
  if (!std::filesystem::exists(file)) return {};
  const std::string bytes = text_of_file(file);
  const std::string_view body = checked(file, bytes);
  try {
    const nlohmann::json document = nlohmann::json::from_cbor(body);
    if (document.at("stamp") != stamp) return {};
    return document.at("part").get<Part>();
  } catch (const nlohmann::json::exception&) {
    damaged(file);
  }
}

}  // namespace springproof
