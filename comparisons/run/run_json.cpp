#include "comparisons/run/run_json.h"

#include "comparisons/results/records_json.h"

namespace springproof {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(RunTimes, set_up, solve)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PatchReaction, patch, force, torque)

namespace {

using nlohmann::json;

json json_of(const ModelSample& s) {
  const Equilibrium& e = s.state;
  const Field& f = s.field;
  return {{"ok", e.ok},
          {"message", e.message},
          {"solver", e.solver},
          {"iterations", e.iterations},
          {"residual", e.residual},
          {"load_reached", e.load_reached},
          {"unknowns", e.unknowns},
          {"memory_MiB", e.memory_MiB},
          {"nodal_displacement", e.displacement},
          {"times", s.times},
          {"displacement", f.displacement},
          {"reactions", f.reactions},
          {"volume_change", f.volume_change},
          {"volume_change_first_order", f.volume_change_first_order},
          {"scalars", s.scalars},
          {"line", s.line},
          {"history", s.motion.history},
          {"frames", s.motion.frames},
          {"stability", s.stability},
          {"stress", s.stress}};
}

ModelSample sample_from(const json& j, const Lattice& lattice) {
  ModelSample s;
  Equilibrium& e = s.state;
  j.at("ok").get_to(e.ok);
  j.at("message").get_to(e.message);
  j.at("solver").get_to(e.solver);
  j.at("iterations").get_to(e.iterations);
  j.at("residual").get_to(e.residual);
  j.at("load_reached").get_to(e.load_reached);
  j.at("unknowns").get_to(e.unknowns);
  j.at("memory_MiB").get_to(e.memory_MiB);
  j.at("nodal_displacement").get_to(e.displacement);
  j.at("times").get_to(s.times);
  if (e.ok) s.field.mesh = lattice.mesh;
  j.at("displacement").get_to(s.field.displacement);
  j.at("reactions").get_to(s.field.reactions);
  j.at("volume_change").get_to(s.field.volume_change);
  j.at("volume_change_first_order").get_to(s.field.volume_change_first_order);
  j.at("scalars").get_to(s.scalars);
  j.at("line").get_to(s.line);
  j.at("history").get_to(s.motion.history);
  j.at("frames").get_to(s.motion.frames);
  j.at("stability").get_to(s.stability);
  j.at("stress").get_to(s.stress);
  return s;
}

}  // namespace

json json_of(const std::vector<ModelSample>& samples) {
  json all = json::array();
  for (const ModelSample& s : samples) all.push_back(json_of(s));
  return all;
}

std::vector<ModelSample> samples_from(const json& j, const Lattice& lattice) {
  std::vector<ModelSample> all;
  for (const json& s : j) all.push_back(sample_from(s, lattice));
  return all;
}

json json_of(const FractureSamples& s) { return {{"runs", s.runs}, {"scalars", s.scalars}, {"cracks", s.cracks}}; }

FractureSamples fracture_samples_from(const json& j) {
  FractureSamples s;
  j.at("runs").get_to(s.runs);
  j.at("scalars").get_to(s.scalars);
  j.at("cracks").get_to(s.cracks);
  return s;
}

}  // namespace springproof
