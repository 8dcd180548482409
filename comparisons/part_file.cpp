#include "comparisons/part_file.h"

#include <fstream>
#include <nlohmann/json.hpp>

namespace nlohmann {

template <class T>
struct adl_serializer<std::optional<T>> {
  static void to_json(json& j, const std::optional<T>& value) { value ? j = *value : j = nullptr; }
  static void from_json(const json& j, std::optional<T>& value) {
    value = j.is_null() ? std::optional<T>() : std::optional<T>(j.get<T>());
  }
};

}  // namespace nlohmann

namespace springproof {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Row, case_name, kinematics, model, poisson_ratio, cells, measure, value, unit,
                                   reference, reference_uncertainty, error, samples, spread)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Run, model, kind, poisson_ratio, cells, kinematics, ok, message, solver, iterations,
                                   residual, seconds, unknowns, memory_MiB, set_up_seconds)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ReferenceRecord, poisson_ratio, measure, unit, cells, values, observed_order, value,
                                   uncertainty, note, element, converging, correlation)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Picture, model, poisson_ratio, cells, rest, displacement, difference, quads,
                                   volume_change, surface)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(LineRecord, model, poisson_ratio, cells, first, last, distance, strain, stress, exact_strain, exact_stress)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ErrorSplit, model, poisson_ratio, cells, voxel_edge, measure, unit, total, model_error, discretisation_error,
                                   geometry_error, voxel_uncertainty, body_uncertainty)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Part, runs, rows, references, pictures, lines, splits)

void save_part(const std::filesystem::path& file, const std::string& stamp, const Part& part) {
  const std::vector<std::uint8_t> bytes = nlohmann::json::to_cbor({{"stamp", stamp}, {"part", part}});
  write_file(file, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

std::optional<Part> load_part(const std::filesystem::path& file, const std::string& stamp) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return {};
  try {
    const nlohmann::json document = nlohmann::json::from_cbor(in);
    if (document.at("stamp") != stamp) return {};
    return document.at("part").get<Part>();
  } catch (const nlohmann::json::exception&) {
    return {};
  }
}

}  // namespace springproof
