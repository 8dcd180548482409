#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "comparisons/commands/export/export_request.h"
#include "comparisons/engines/engine_files.h"
#include "problem/case_file/experiment.h"
#include "problem/files/files.h"
#include "problem/system/streams.h"

namespace springproof {
namespace {

namespace fs = std::filesystem;

constexpr const char* skeleton = "msm_18";  // whose nodes are the corners of the cubes

/// An engine: a row.
struct EngineForm {
  const char* name;
  const char* ending;
  const char* without_springs;  ///< why it has no springs; null: it has
  std::string (*write)(const SpringsFile&, const std::vector<std::string>& pinned);
};
constexpr EngineForm engines[] = {
    {"jolt", ".json", nullptr, jolt_json},
    {"bullet", ".json",
     "Bullet's links have no modulus, only a share from 0 to 1 per iteration, and its deformable springs one constant "
     "for all",
     bullet_json},
    {"mujoco", ".xml", "MuJoCo's solids are flexes of tetrahedra", mujoco_mjcf}};

/// The patches that the loads of a case hold or move in all three directions.
std::vector<std::string> held_patches(const Experiment& experiment) {
  std::vector<std::string> held;
  for (const Load& load : experiment.loads) {
    if (!prescribes_displacement(load)) continue;
    const PrescribedValue u = prescribed_displacement(load, Vec3::Zero(), Kinematics::linear, 1);
    const std::string& patch = *patch_of(load);
    if (u[0] && u[1] && u[2] && std::ranges::find(held, patch) == held.end()) held.push_back(patch);
  }
  return held;
}

}  // namespace

int export_engine(const ExportRequest& asked) {
  ExportRequest request = asked;
  const EngineForm& engine =
      *std::find_if(std::begin(engines), std::end(engines), [&](const EngineForm& e) { return e.name == request.to; });
  const fs::path file = request.out.empty() ? fs::path(request.what).stem().string() + engine.ending : request.out;
  if (file.extension() != engine.ending)
    throw InputError(fmt::format("--out: is {} (allowed with --to {}: a name that ends in {})", file.string(),
                                 engine.name, engine.ending));
  if (engine.without_springs && !request.model.empty())
    throw InputError(
        fmt::format("--model: is {}: {} (allowed with --to {}: no --model; it gets tetrahedra of E and nu)",
                    request.model, engine.without_springs, engine.name));
  if (request.model.empty()) request.model = skeleton;
  const SpringsFile springs = springs_of(request);
  const auto held = is_body(request.what) ? held_patches(request) : held_patches(read_case(request));
  write_named_file(file, engine.write(springs, held));
  const Network& network = springs.model.network;
  to_stdout("{}: {} nodes, {}, {:.4g} kg, E = {:g} Pa, nu = {:g}, pinned: {}\n", file.string(), network.nodes(),
            engine.without_springs ? fmt::format("{} tetrahedra", 5 * network.cells.size())
                                   : fmt::format("{} edges", network.springs.size()),
            springs.derived.at("mass_kg"), springs.material->youngs_modulus, springs.material->poisson_ratio,
            held.empty() ? "none" : fmt::format("{}", fmt::join(held, ", ")));
  return 0;
}

}  // namespace springproof
