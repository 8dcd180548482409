#include <fmt/format.h>

#include "comparisons/results/records_json.h"
#include "comparisons/run/expected_runs.h"
#include "comparisons/run/part_run.h"

namespace springproof {

// Without the supports' forces, which are in the reactions.
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(RunTimes, set_up, solve)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PatchReaction, patch, force, torque)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Equilibrium, ok, message, solver, iterations, residual, load_reached, unknowns,
                                   memory_MiB, displacement)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Field, displacement, reactions, volume_change, volume_change_first_order)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(MotionRecord, history, frames)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ModelSample, state, times, field, scalars, line, motion, stability, stress)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(FractureSamples, runs, scalars, cracks)

std::string name_of_samples(std::size_t lattice, ChosenModel model) {
  return fmt::format("model-{}-{}{}", model.number, lattice, model.whole_cubes ? "-whole" : "");
}

nlohmann::json json_of(const std::vector<ModelSample>& samples) { return samples; }

std::vector<ModelSample> samples_of(const PartRun& run, std::size_t lattice, ChosenModel model) {
  const Lattice& on = run.prepared.lattices[lattice];
  std::vector<ModelSample> samples =
      run.keeper.run(name_of_samples(lattice, model), cost_of_model(run.prepared, on, model.number, run.material),
                     [&] { return run_samples(run.prepared, on, model, run.material); });
  for (ModelSample& s : samples)
    if (s.state.ok) s.field.mesh = on.mesh;  // which is not kept
  return samples;
}

FractureSamples fracture_samples_of(const PartRun& run, std::size_t lattice, std::size_t number) {
  const Lattice& on = run.prepared.lattices[lattice];
  const RunKey key = run.key(run.experiment().models[number].label, lattice);
  const std::filesystem::path vtu =
      run.vtu.folder.empty() ? run.vtu.folder : run.vtu.folder / (file_stem(key) + ".vtu");
  return run.keeper.run(name_of_samples(lattice, {number}), cost_of_model(run.prepared, on, number, run.material),
                        [&] { return run_fracture_samples(run.prepared, on, number, run.material, vtu); });
}

}  // namespace springproof
