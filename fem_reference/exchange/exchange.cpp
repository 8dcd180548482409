#include "fem_reference/exchange/exchange.h"

#include <nlohmann/json.hpp>

#include "meshes/mesh_json.h"
#include "problem/system/json.h"

namespace springproof {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(IsotropicMaterial, youngs_modulus, poisson_ratio, density)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(KelvinSolution, force, at, material)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Wrench, force, moment, about)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PrescribedDisplacement, on, displacement)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PrescribedAffine, on, gradient, offset)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PrescribedRotation, on, point, axis, angle)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PrescribedField, on, field, kelvin)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Traction, on, traction, wrench)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Pressure, on, pressure, wrench)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PatchForce, on, force, wrench)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Gravity, acceleration, wrench)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PointForce, at, force)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(FieldBodyForce, field)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(AttachedMass, name, on, at, mass, weighs)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PatchReaction, patch, force, torque)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(RunTimes, set_up, solve)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Course, ramp, pulse, frequency)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(RelaxationBranch, share, time)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Relaxation, branches)

namespace fem {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Discretisation, cells, element, grading, mesh, refinements, times_cells, steps, vtu)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(MotionRequest, duration, damping, course, released, velocity, spin, viscosity,
                                   relaxation, energy_momentum)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(RegionMeans, volume_change, displacement, stress, energy)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(InterfaceForce, material, other, force)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Solution, grid, ok, message, form, law, displacement, stress, reactions, regions,
                                   interfaces, volume_change, volume_change_first_order, min_jacobian,
                                   degrees_of_freedom, unknowns, cells, cells_per_process, iterations, residual,
                                   seconds, times, memory_MiB, frequencies, shapes, rigid_motions, time, path,
                                   kinetic_energy, elastic_energy, angular_momentum)

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Request, name, size, law, material, loads, grids, points, stress_points, tolerance,
                                   cost, vtu_single, modes, motion, masses)

nlohmann::json to_json(const Request& r) {
  nlohmann::json out = r;
  out["geo"] = r.geo.string();
  out["regions"] = materials_of(r.regions);
  out["meshes"] = nlohmann::json::array();
  for (const auto& mesh : r.meshes) out["meshes"].push_back(to_json(*mesh));
  return out;
}

Request request_from_json(const nlohmann::json& j) {
  auto r = j.get<Request>();
  r.geo = j.at("geo").get<std::string>();
  for (const IsotropicMaterial& m : j.at("regions").get<std::vector<IsotropicMaterial>>())
    r.regions.push_back({{}, m, {}});
  for (const auto& mesh : j.at("meshes")) r.meshes.push_back(std::make_shared<Mesh>(mesh_from_json(mesh)));
  return r;
}

nlohmann::json to_json(const std::vector<Solution>& solutions) {
  nlohmann::json all = nlohmann::json::array();
  for (const Solution& s : solutions) all.push_back(s);
  return all;
}

std::vector<Solution> solutions_from_json(const nlohmann::json& j) { return j.get<std::vector<Solution>>(); }

}  // namespace fem
}  // namespace springproof
