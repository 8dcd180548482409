#include "comparisons/run/model_samples.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "comparisons/run/expected_runs.h"
#include "comparisons/run/run_json.h"

namespace springproof {

std::string name_of_samples(std::size_t lattice, std::size_t number, bool whole) {
  return fmt::format("model-{}-{}{}", number, lattice, whole ? "-whole" : "");
}

std::vector<ModelSample> samples_of(const PartRun& run, std::size_t lattice, std::size_t number, bool whole) {
  const Lattice& on = run.prepared.lattices[lattice];
  return run.keeper.run(
      name_of_samples(lattice, number, whole), cost_of_model(run.prepared, on, number, run.material),
      [&] {
        if (!whole) return run_samples(run.prepared, on, number, run.material);
        PreparedCase changed = run.prepared;
        changed.models[number].cut = false;
        return run_samples(changed, on, number, run.material);
      },
      [](const std::vector<ModelSample>& samples) { return json_of(samples); },
      [&](const nlohmann::json& kept) { return samples_from(kept, on); });
}

FractureSamples fracture_samples_of(const PartRun& run, std::size_t lattice, std::size_t number) {
  const Lattice& on = run.prepared.lattices[lattice];
  const RunKey key = run.key(run.experiment().models[number].label, lattice);
  const std::filesystem::path vtu = run.vtu.folder.empty() ? run.vtu.folder : run.vtu.folder / (vtu_stem(key) + ".vtu");
  return run.keeper.run(
      name_of_samples(lattice, number), cost_of_model(run.prepared, on, number, run.material),
      [&] { return run_fracture_samples(run.prepared, on, number, run.material, vtu); },
      [](const FractureSamples& samples) { return json_of(samples); }, fracture_samples_from);
}

}  // namespace springproof
