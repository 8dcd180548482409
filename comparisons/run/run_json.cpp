#include "comparisons/run/run_json.h"

#include "comparisons/results/records_json.h"

namespace springproof {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(RunTimes, set_up, solve)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PatchReaction, patch, force, torque)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Equilibrium, ok, message, solver, iterations, residual, load_reached, unknowns,
                                   memory_MiB, displacement)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Field, displacement, reactions, volume_change, volume_change_first_order)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(MotionRecord, history, frames)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ModelSample, state, times, field, scalars, line, motion, stability, stress)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(FractureSamples, runs, scalars, cracks)

nlohmann::json json_of(const std::vector<ModelSample>& samples) { return samples; }

std::vector<ModelSample> samples_from(const nlohmann::json& json, const Lattice& lattice) {
  auto all = json.get<std::vector<ModelSample>>();
  for (ModelSample& s : all)
    if (s.state.ok) s.field.mesh = lattice.mesh;
  return all;
}

nlohmann::json json_of(const FractureSamples& samples) { return samples; }

FractureSamples fracture_samples_from(const nlohmann::json& json) { return json.get<FractureSamples>(); }

}  // namespace springproof
