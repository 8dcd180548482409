#include "comparisons/bench/engine_adapter.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "comparisons/bench/interrupt.h"
#include "comparisons/engines/engine_files.h"
#include "msm/dynamics/time_step.h"
#include "msm/models.h"
#include "problem/system/files.h"
#include "problem/system/input_error.h"
#include "problem/system/streams.h"

namespace springproof::bench {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

constexpr double time_limit = 600;  // [s] of one task
constexpr double far_away = 100;    // [m]

Json rows(const NodalVectors& v) {
  if (v.rows() == 0) return nullptr;
  Json out = Json::array();
  for (Eigen::Index n = 0; n < v.rows(); ++n) out.push_back({v(n, 0), v(n, 1), v(n, 2)});
  return out;
}

/// A number; null, which JSON has for those that are none, is not a number.
double number(const Json& j) { return j.is_null() ? std::nan("") : j.get<double>(); }

NodalVectors vectors(const Json& rows, Eigen::Index nodes, const char* what) {
  if (!rows.is_array() || Eigen::Index(rows.size()) != nodes)
    throw std::runtime_error(fmt::format("{} of {} nodes instead of {}", what, rows.size(), nodes));
  NodalVectors out(nodes, 3);
  for (Eigen::Index n = 0; n < nodes; ++n) {
    if (rows[n].size() != 3) throw std::runtime_error(fmt::format("{}: node {} has no three components", what, n));
    for (int c = 0; c < 3; ++c) out(n, c) = number(rows[n][c]);
  }
  return out;
}

long samples_every(const EngineTask& task) { return std::max(1L, std::lround(1.0 / 60 / task.time_step)); }

Json to_json(const EngineSetUp& set_up, const EngineTask& task, const EngineBar& bar) {
  Json fields = Json::array();
  for (const NodalVectors& u : task.fields) fields.push_back(rows(u));
  return {{"set_up", set_up.set_up},
          {"integrator", task.integrator},
          {"iterations", task.iterations},
          {"dt_s", task.time_step},
          {"steps", task.steps()},
          {"free_steps", std::lround(task.free / task.time_step)},
          {"sample_every", samples_every(task)},
          {"damping_1_s", task.damping},
          {"gravity_m_s2", {0, 0, -task.gravity}},
          {"forces_N", rows(task.forces)},
          {"velocities_m_s", rows(task.velocities)},
          {"pinned", task.pinned},
          {"watch", bar.watched},
          {"watch_weights", bar.weights},
          {"fields_m", task.fields.empty() ? Json() : fields}};
}

EngineSample sample_of(const Json& s) {
  if (!s.is_array() || s.size() != 8) throw std::runtime_error("a sample has not eight numbers");
  return {number(s[0]), number(s[1]), Vec3(number(s[2]), number(s[3]), number(s[4])),
          Vec3(number(s[5]), number(s[6]), number(s[7]))};
}

void check_start(const EngineSample& first, const EngineBar& bar) {
  Vec3 tip = Vec3::Zero();
  for (std::size_t i = 0; i < bar.watched.size(); ++i)
    tip += bar.weights[i] * bar.mesh.nodes.row(bar.watched[i]).transpose();
  if (!((first.tip - tip).norm() < 1e-4))
    throw std::runtime_error(fmt::format("its body is another: the end face starts at x = {:g} m", first.tip[0]));
}

void check_held(const NodalVectors& x, const EngineBar& bar) {
  for (Eigen::Index n = 0; n < x.rows(); ++n)
    if (bar.mesh.nodes(n, 0) == 0 && !((x.row(n) - bar.mesh.nodes.row(n)).norm() < 1e-4))
      throw std::runtime_error(fmt::format("node {}, which is held, has moved", n));
}

/// The bar as a springs file of msm_18, from which the exports are made.
SpringsFile springs_of_bar(const EngineBar& bar, const IsotropicMaterial& material) {
  SpringsFile file;
  file.model = build_model(resolve({"msm_18", {}, "msm_18", {}}), bar.mesh, material);
  file.density = material.density;
  file.material = material;
  for (const Patch& patch : bar.mesh.patches) file.patches[patch.name] = nodes_of(patch);
  file.origin = {"springproof bench", "msm_18", {}, "bar", ""};
  file.derived = {{"safe_time_step_s", safe_time_step(file.model, material.density)}};
  return file;
}

/// The package of an adapter that runs in node; nothing for our own springs.
std::string package_of(const std::string& adapter) {
  return adapter == "jolt" ? "jolt-physics" : adapter == "mujoco" ? "@mujoco/mujoco" : "";
}

Json json_of_file(const fs::path& file) { return Json::parse(text_of_file(file), nullptr, false); }

}  // namespace

long EngineTask::steps() const { return std::lround(duration / time_step); }

EngineAnswer read_answer(const Json& answer, const EngineTask& task, const EngineBar& bar) {
  EngineAnswer out;
  const Eigen::Index nodes = bar.mesh.nodes.rows();
  out.engine = answer.at("engine").get<std::string>();
  if (!task.fields.empty() && !answer.at("forces_N").is_null()) {
    if (answer["forces_N"].size() != task.fields.size())
      throw std::runtime_error("forces of other fields than asked for");
    for (const Json& f : answer["forces_N"]) out.forces.push_back(vectors(f, nodes, "forces"));
    for (const NodalVectors& f : out.forces)
      if (!f.allFinite()) throw std::runtime_error("forces that are no numbers");
  }
  if (task.steps() == 0) return out;
  out.steps = answer.at("steps");
  out.seconds = answer.at("seconds");
  out.x = vectors(answer.at("positions_m"), nodes, "positions");
  for (const Json& s : answer.at("samples")) out.samples.push_back(sample_of(s));
  const long expected = 1 + (task.steps() + samples_every(task) - 1) / samples_every(task);
  if (out.steps != task.steps() || long(out.samples.size()) != expected)
    throw std::runtime_error(fmt::format("{} steps with {} samples instead of {} with {}", out.steps,
                                         out.samples.size(), task.steps(), expected));
  check_start(out.samples.front(), bar);
  out.burst = !out.x.allFinite() || out.x.cwiseAbs().maxCoeff() > far_away;
  if (task.pinned && !out.burst) check_held(out.x, bar);
  return out;
}

fs::path adapters_folder() { return data_folder("engines", SPRINGPROOF_ENGINES_DIR); }

fs::path packages_folder() {
  if (const char* given = std::getenv("SPRINGPROOF_ENGINES")) return given;
  return cache_folder() / "engines";
}

std::string missing_for(const std::string& adapter) {
  if (adapter == "bullet")
    return find_program("springproof-engine-bullet", "SPRINGPROOF_ENGINE_BULLET").empty()
               ? "install Debian's packages libbullet-dev and pkg-config, configure and build again"
               : "";
  if (program_on_path("node").empty()) return "install node (Debian's packages nodejs and npm)";
  const std::string package = package_of(adapter);
  if (package.empty()) return "";
  const Json wanted = json_of_file(adapters_folder() / "package.json");
  const Json there = json_of_file(packages_folder() / "node_modules" / package / "package.json");
  if (there.is_object() && there.value("version", "") == wanted.at("dependencies").at(package)) return "";
  return fmt::format("springproof bench engines --install (npm ci of {} {} in {}{})", package,
                     wanted.at("dependencies").at(package).get<std::string>(), packages_folder().string(),
                     there.is_object() ? ", where another version is" : "");
}

/// npm replaces all packages of the folder.
/// @throws InputError where they are of another program.
void require_no_other_packages(const fs::path& folder) {
  std::error_code ignored;
  const Json there = json_of_file(folder / "package.json"), ours = json_of_file(adapters_folder() / "package.json");
  const bool none = !fs::exists(folder / "package.json", ignored) && !fs::exists(folder / "node_modules", ignored);
  if (none || (there.is_object() && there.value("name", "") == ours.at("name"))) return;
  throw InputError(
      fmt::format("SPRINGPROOF_ENGINES: {} has packages of another program (allowed: a folder without "
                  "package.json and node_modules, or one that --install made)",
                  folder.string()));
}

void install_packages() {
  const fs::path npm = program_on_path("npm"), folder = packages_folder();
  require_no_other_packages(folder);
  if (npm.empty()) throw std::runtime_error("--install: npm is not on PATH (Debian's packages nodejs and npm)");
  fs::create_directories(folder);
  for (const char* file : {"package.json", "package-lock.json"})
    write_file(folder / file, text_of_file(adapters_folder() / file));
  to_stderr("npm ci in {} ...\n", folder.string());
  const ChildEnd end =
      run_child({npm, {"ci", "--ignore-scripts", "--no-audit", "--no-fund"}, folder, {}, {}, time_limit});
  if (!end.ok())
    throw std::runtime_error(fmt::format("--install: npm ci in {} {}", folder.string(), words_for(end, time_limit)));
}

fs::path EngineRuns::file(EngineSetUp::File kind, double poisson_ratio, bool pinned) {
  const std::string name = fmt::format("{}-{:g}-{}", int(kind), poisson_ratio, pinned);
  if (const auto known = files_.find(name); known != files_.end()) return known->second;
  const SpringsFile springs = springs_of_bar(bar_, bar_material(poisson_ratio));
  const EngineBody body{springs, pinned ? std::vector<std::string>{"x_min"} : std::vector<std::string>{}};
  const fs::path path = folder_.path / name;
  write_file(path, kind == EngineSetUp::File::edges        ? jolt_json(body)
                   : kind == EngineSetUp::File::tetrahedra ? bullet_json(body)
                                                           : mujoco_mjcf(body));
  return files_[name] = path;
}

int EngineRuns::exported_substeps(double time_step) {
  const Json exported = json_of_file(file(EngineSetUp::File::edges, 0.25, true));
  return int(std::ceil(time_step / exported.at("substeps").at("most_s").get<double>()));
}

EngineAnswer EngineRuns::run(const EngineSetUp& set_up, double poisson_ratio, const EngineTask& task) {
  using File = EngineSetUp::File;
  Json json = to_json(set_up, task, bar_);
  const File kind = set_up.file == File::mjcf ? File::tetrahedra : set_up.file;
  json["model"] = file(kind, poisson_ratio, task.pinned).string();
  if (set_up.file == File::mjcf) json["mjcf"] = file(File::mjcf, poisson_ratio, task.pinned).string();
  const fs::path in = folder_.path / "task", out = folder_.path / "answer", errors = folder_.path / "errors";
  write_file(in, json.dump());
  const bool native = set_up.adapter == "bullet";
  const fs::path program =
      native ? find_program("springproof-engine-bullet", "SPRINGPROOF_ENGINE_BULLET") : program_on_path("node");
  std::vector<std::string> arguments = {in.string()};
  if (!native) arguments.insert(arguments.begin(), (adapters_folder() / (set_up.adapter + ".mjs")).string());
  setenv("SPRINGPROOF_ENGINES", packages_folder().c_str(), 1);
  for (const fs::path& old : {out, errors}) fs::remove(old);  // what a child writes is added
  const ChildEnd end = run_child({program, arguments, {}, out, errors, time_limit});
  throw_if_interrupted();
  const auto last_words = [&] {
    const std::string text = trimmed(text_of_file(errors));
    return text.substr(text.size() > 300 ? text.size() - 300 : 0);
  };
  if (!end.ok())
    throw std::runtime_error(fmt::format("{} {}: {}", set_up.adapter, words_for(end, time_limit), last_words()));
  const Json answer = Json::parse(text_of_file(out), nullptr, false);
  if (!answer.is_object())
    throw std::runtime_error(fmt::format("{} did not answer in JSON {}", set_up.adapter, last_words()));
  try {
    return read_answer(answer, task, bar_);
  } catch (const std::exception& e) {
    throw std::runtime_error(fmt::format("answer of {} not believed: {}", set_up.adapter, e.what()));
  }
}

}  // namespace springproof::bench
