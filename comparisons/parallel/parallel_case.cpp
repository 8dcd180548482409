#include "comparisons/parallel/parallel_case.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

namespace springproof {
namespace {

template <class Value>
void keep_last(std::vector<Value>& values) {
  if (values.size() > 1) values.erase(values.begin(), values.end() - 1);
}

void set_resolution(const ParallelOptions& options, Body& body) {
  keep_last(body.cells);
  keep_last(body.voxel_edges);
  keep_last(body.voxel_counts);
  keep_last(body.accuracies);
  if (body.is_voxels() && options.cells)
    throw InputError(body.where, "--cells: the body is divided into voxels (allowed: --voxels)");
  if (!body.is_voxels() && options.voxels)
    throw InputError(body.where, "--voxels: the body is divided into cells (allowed: --cells)");
  if (options.cells) body.cells = {*options.cells};
  if (!options.voxels) return;
  body.voxel_edges.clear();
  body.accuracies.clear();
  body.voxel_counts = {*options.voxels};
}

ModelChoice choose_model(const Experiment& e, const std::string& name) {
  const auto labelled = std::find_if(e.models.begin(), e.models.end(),
                                     [&](const ModelChoice& m) { return m.label == name && !m.in_motion; });
  return labelled == e.models.end() ? ModelChoice{name, {}, name, {}} : *labelled;
}

}  // namespace

ParallelCase read_parallel_case(const ParallelOptions& options) {
  ParallelCase c{read_experiment(options.case_file), {0, 0, 0}, {}, {}};
  Experiment& e = c.experiment;
  set_resolution(options, e.body);
  if (!e.body.cells.empty()) c.cells = e.body.cells.back();
  c.material = e.materials.front();
  if (options.poisson_ratio) c.material.poisson_ratio = *options.poisson_ratio;
  const ModelChoice choice = choose_model(e, options.model);
  c.model = resolve(choice);
  e.models = {choice};
  e.materials = {c.material};
  e.kinematics = "linear";
  e.elements.clear();
  e.reference.elements.clear();
  e.reference.in_time = false;
  e.dynamics.reset();
  e.fracture.reset();
  return c;
}

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace springproof
