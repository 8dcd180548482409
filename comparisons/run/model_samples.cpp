#include "comparisons/run/model_samples.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "comparisons/run/expected_runs.h"
#include "comparisons/run/run_json.h"

namespace springproof {

std::string name_of_samples(std::size_t lattice, ChosenModel model) {
  return fmt::format("model-{}-{}{}", model.number, lattice, model.whole_cubes ? "-whole" : "");
}

std::vector<ModelSample> samples_of(const PartRun& run, std::size_t lattice, ChosenModel model) {
  const Lattice& on = run.prepared.lattices[lattice];
  return run.keeper.run(
      name_of_samples(lattice, model), cost_of_model(run.prepared, on, model.number, run.material),
      [&] { return run_samples(run.prepared, on, model, run.material); },
      [](const std::vector<ModelSample>& samples) { return json_of(samples); },
      [&](const nlohmann::json& kept) { return samples_from(kept, on); });
}

FractureSamples fracture_samples_of(const PartRun& run, std::size_t lattice, std::size_t number) {
  const Lattice& on = run.prepared.lattices[lattice];
  const RunKey key = run.key(run.experiment().models[number].label, lattice);
  const std::filesystem::path vtu =
      run.vtu.folder.empty() ? run.vtu.folder : run.vtu.folder / (file_stem(key) + ".vtu");
  return run.keeper.run(
      name_of_samples(lattice, {number}), cost_of_model(run.prepared, on, number, run.material),
      [&] { return run_fracture_samples(run.prepared, on, number, run.material, vtu); },
      [](const FractureSamples& samples) { return json_of(samples); }, fracture_samples_from);
}

}  // namespace springproof
