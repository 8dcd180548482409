#include "fem_reference/exchange.h"

#include <nlohmann/json.hpp>

#include "meshes/mesh_json.h"

namespace springproof::fem {
namespace {

using nlohmann::json;

json rows(const NodalVectors& v) { return std::vector<double>(v.data(), v.data() + v.size()); }

NodalVectors to_rows(const json& j) {
  const auto flat = j.get<std::vector<double>>();
  return Eigen::Map<const NodalVectors>(flat.data(), flat.size() / 3, 3);
}

json vec(const Vec3& v) { return {v[0], v[1], v[2]}; }

Vec3 to_vec(const json& j) { return Vec3(j.at(0), j.at(1), j.at(2)); }

json grid(const Discretisation& g) {
  return {{"cells", g.cells},
          {"element", g.element},
          {"grading", g.grading},
          {"mesh", g.mesh},
          {"refinements", g.refinements}};
}

Discretisation to_grid(const json& j) {
  return {j.at("cells"), j.at("element"), j.at("grading"), j.at("mesh"), j.at("refinements")};
}

// Case files do not say it: it is the body's, known once the body is meshed.
json wrench(const Load& load) {
  const auto* w = wrench_of(load);
  if (!w || !*w) return nullptr;
  return {vec((*w)->force), vec((*w)->moment), vec((*w)->about)};
}

json solution(const Solution& s) {
  json reactions = json::array();
  for (const PatchReaction& r : s.reactions)
    reactions.push_back({{"patch", r.patch}, {"force", vec(r.force)}, {"torque", vec(r.torque)}});
  return {{"grid", grid(s.grid)},
          {"ok", s.ok},
          {"message", s.message},
          {"form", s.form},
          {"law", s.law},
          {"displacement", rows(s.displacement)},
          {"stress", std::vector<double>(s.stress.data(), s.stress.data() + s.stress.size())},
          {"reactions", reactions},
          {"volume_change", s.volume_change},
          {"volume_change_first_order", s.volume_change_first_order},
          {"min_jacobian", s.min_jacobian},
          {"degrees_of_freedom", s.degrees_of_freedom},
          {"unknowns", s.unknowns},
          {"iterations", s.iterations},
          {"residual", s.residual},
          {"seconds", s.seconds},
          {"set_up_seconds", s.times.set_up},
          {"solve_seconds", s.times.solve},
          {"memory_MiB", s.memory_MiB}};
}

Solution to_solution(const json& j) {
  Solution s;
  s.grid = to_grid(j.at("grid"));
  s.ok = j.at("ok");
  s.message = j.at("message");
  s.form = j.at("form");
  s.law = j.at("law");
  s.displacement = to_rows(j.at("displacement"));
  const auto stress = j.at("stress").get<std::vector<double>>();
  s.stress = Eigen::Map<const Stresses>(stress.data(), stress.size() / 6, 6);
  for (const json& r : j.at("reactions"))
    s.reactions.push_back({r.at("patch"), to_vec(r.at("force")), to_vec(r.at("torque"))});
  s.volume_change = j.at("volume_change");
  s.volume_change_first_order = j.at("volume_change_first_order");
  s.min_jacobian = j.at("min_jacobian");
  s.degrees_of_freedom = j.at("degrees_of_freedom");
  s.unknowns = j.at("unknowns");
  s.iterations = j.at("iterations");
  s.residual = j.at("residual");
  s.seconds = j.at("seconds");
  s.times = {j.at("set_up_seconds"), j.at("solve_seconds")};
  s.memory_MiB = j.at("memory_MiB");
  return s;
}

}  // namespace

json to_json(const Request& request) {
  json grids = json::array(), meshes = json::array(), wrenches = json::array();
  for (const Discretisation& g : request.grids) grids.push_back(grid(g));
  for (const auto& mesh : request.meshes) meshes.push_back(to_json(*mesh));
  for (const Load& load : request.experiment.loads) wrenches.push_back(wrench(load));
  return {{"experiment", to_toml(request.experiment)},
          {"file", request.experiment.file.string()},
          {"youngs_modulus", request.material.youngs_modulus},
          {"poisson_ratio", request.material.poisson_ratio},
          {"density", request.material.density},
          {"grids", grids},
          {"points", rows(request.points)},
          {"stress_points", rows(request.stress_points)},
          {"tolerance", request.tolerance},
          {"meshes", meshes},
          {"wrenches", wrenches}};
}

Request request_from_json(const json& j) {
  Request request;
  request.experiment = parse_experiment(j.at("experiment"), std::string(j.at("file")));
  request.material = {j.at("youngs_modulus"), j.at("poisson_ratio"), j.at("density")};
  for (const json& g : j.at("grids")) request.grids.push_back(to_grid(g));
  request.points = to_rows(j.at("points"));
  request.stress_points = to_rows(j.at("stress_points"));
  request.tolerance = j.at("tolerance");
  for (const json& mesh : j.at("meshes")) request.meshes.push_back(std::make_shared<Mesh>(mesh_from_json(mesh)));
  for (std::size_t l = 0; l < request.experiment.loads.size(); ++l)
    if (const json& w = j.at("wrenches").at(l); !w.is_null())
      *wrench_of(request.experiment.loads[l]) = Wrench{to_vec(w.at(0)), to_vec(w.at(1)), to_vec(w.at(2))};
  return request;
}

json to_json(const std::vector<Solution>& solutions) {
  json all = json::array();
  for (const Solution& s : solutions) all.push_back(solution(s));
  return all;
}

std::vector<Solution> solutions_from_json(const json& j) {
  std::vector<Solution> all;
  for (const json& s : j) all.push_back(to_solution(s));
  return all;
}

}  // namespace springproof::fem
