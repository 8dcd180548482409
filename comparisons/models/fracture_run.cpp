#include "comparisons/models/fracture_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "comparisons/models/model_run.h"
#include "comparisons/results/crack_picture.h"
#include "meshes/field.h"
#include "msm/embedding/boundary.h"
#include "msm/fracture/cracks.h"
#include "msm/fracture/fracture.h"
#include "msm/models.h"
#include "problem/system/progress.h"
#include "problem/system/run_cost.h"

namespace springproof {
namespace {

constexpr int recorded_states = 20;  // of a curve against drying

/// A network that has dried.
struct Dried {
  Network network;
  FractureResult result;

  std::vector<char> broken() const {
    std::vector<char> flags;
    for (const int at : result.broken_at) flags.push_back(at > 0);
    return flags;
  }
};

/// Nodes at rest in all directions.
std::vector<char> held_nodes(const BoundaryConditions& conditions) {
  std::vector<char> held;
  for (std::size_t at = 0; at < conditions.fixed.size(); at += 3) held.push_back(conditions.fixed[at]);
  return held;
}

Dried dry(const PreparedCase& prepared, const Lattice& lattice, const ModelParameters& parameters,
          const IsotropicMaterial& material, std::uint64_t seed, Run& run) {
  const Experiment& e = prepared.experiment;
  const double start = cpu_seconds();
  EmbeddedModel built = build_embedded(parameters, *lattice.mesh, material, lattice.region.get());
  const std::vector<char> held = held_nodes(transfer(prepared.loads, *lattice.mesh, built.embedding,
                                                     built.model.network, material.density, Kinematics::linear));
  const double ready = cpu_seconds();
  Dried dried{std::move(built.model.network), {}};
  dried.result = run_fracture(dried.network, held, *e.fracture, seed);
  run.ok = true;
  run.solver = fmt::format("{} equilibria by CG", dried.result.solves);
  run.iterations = static_cast<int>(dried.result.iterations);
  run.residual = dried.result.worst_residual;
  run.set_up_seconds = ready - start;
  run.seconds = cpu_seconds() - ready;
  run.unknowns = 3 * std::ranges::count(held, 0);
  run.memory_MiB = peak_memory_MiB();
  return dried;
}

std::map<std::string, double> measures_of(const Dried& dried) {
  const Network& network = dried.network;
  const FractureResult& r = dried.result;
  const std::vector<char> broken = dried.broken();
  const double area = crack_area(network, broken);
  std::map<std::string, double> out = {
      {"fracture.broken", r.steps.back().broken / static_cast<double>(network.springs.size())},
      {"fracture.crack_area_per_volume", area / network.volume.sum()},
      {"fracture.fragments", r.steps.back().fragments},
      {"fracture.stored", r.steps.back().stored},
      {"fracture.released", r.released()},
      {"fracture.imbalance", r.imbalance()}};
  if (area > 0) out["fracture.released_per_area"] = r.released() / area;
  for (const FractureStep& step : r.steps)
    if (step.broken > 0) {
      out["fracture.first_shrinkage"] = step.shrinkage;
      break;
    }
  const CrackDirections d = crack_directions(network, broken);
  if (d.springs > 0)
    out.merge(std::map<std::string, double>{{"fracture.along_4", d.along_4},
                                            {"fracture.along_8", d.along_8},
                                            {"fracture.order_4", d.order_4},
                                            {"fracture.order_8", d.order_8}});
  add_network(network, out);
  return out;
}

/// Where cracks are open: broken springs of the upper half whose ends have moved apart by more than twice the
/// threshold.
std::vector<char> open_cracks(const Dried& dried, const Fracture& fracture) {
  const Network& network = dried.network;
  const FractureResult& r = dried.result;
  const std::vector<double> profile = drying_profile(fracture, network);
  const double half = (network.X.col(2).maxCoeff() + network.X.col(2).minCoeff()) / 2;
  std::vector<char> open;
  for (std::size_t n = 0; n < network.springs.size(); ++n) {
    const Spring& s = network.springs[n];
    const Eigen::RowVector3d rest = network.X.row(s.j) - network.X.row(s.i),
                             moved = r.displacement.row(s.j) - r.displacement.row(s.i);
    const double stretch = rest.dot(moved) / rest.squaredNorm() + fracture.shrinkage * profile[n];
    open.push_back(r.broken_at[n] > 0 && stretch > 2 * fracture.threshold &&
                   (network.X(s.i, 2) + network.X(s.j, 2)) / 2 > half);
  }
  return open;
}

/// The springs of the top layer, displaced with it, and strokes across the broken springs of open cracks: the trace of
/// the plane normal to the spring.
std::string picture_of(const Dried& dried, const Fracture& fracture) {
  const Network& network = dried.network;
  const FractureResult& r = dried.result;
  const std::vector<char> open = open_cracks(dried, fracture);
  const double top = network.X.col(2).maxCoeff();
  double length = 0;
  for (const Spring& s : network.springs) length += s.rest_length / static_cast<double>(network.springs.size());
  const int last = *std::ranges::max_element(r.broken_at);
  int first = last;
  for (const int at : r.broken_at)
    if (at > 0) first = std::min(first, at);
  std::vector<Stroke> springs, cracks;
  for (std::size_t n = 0; n < network.springs.size(); ++n) {
    const Spring& s = network.springs[n];
    const Vec3 a = (network.X.row(s.i) + r.displacement.row(s.i)).transpose(),
               b = (network.X.row(s.j) + r.displacement.row(s.j)).transpose();
    const Vec3 rest = (network.X.row(s.j) - network.X.row(s.i)).transpose();
    const double low = std::min(network.X(s.i, 2), network.X(s.j, 2)), level = rest.head<2>().norm();
    if (r.broken_at[n] == 0 && low > top - length) springs.push_back({a.x(), a.y(), b.x(), b.y()});
    if (!open[n] || level < 0.3 * s.rest_length) continue;
    const Vec3 middle = (a + b) / 2, along = 0.4 * length / level * Vec3(-rest.y(), rest.x(), 0);
    cracks.push_back({middle.x() - along.x(), middle.y() - along.y(), middle.x() + along.x(), middle.y() + along.y(),
                      last > first ? (r.broken_at[n] - first) / static_cast<double>(last - first) : 0});
  }
  return crack_svg(springs, cracks);
}

/// Adds a sample to the sums of the curves.
void add_curves(const Dried& dried, CrackRecord& record) {
  const std::vector<FractureStep>& steps = dried.result.steps;
  const int states = std::min(recorded_states, static_cast<int>(steps.size()));
  for (auto* curve : {&record.shrinkage, &record.broken, &record.fragments, &record.stored, &record.released})
    curve->resize(states, 0);
  record.directions.resize(direction_bins, 0);
  for (int state = 0; state < states; ++state) {
    const std::size_t step = (state + 1) * steps.size() / states;
    const FractureStep& s = steps[step - 1];
    record.shrinkage[state] += s.shrinkage;
    record.broken[state] += s.broken / static_cast<double>(dried.network.springs.size());
    record.fragments[state] += s.fragments;
    record.stored[state] += s.stored;
    record.released[state] += s.broken_energy + s.relaxed;
  }
  const CrackDirections d = crack_directions(dried.network, dried.broken());
  for (int bin = 0; bin < direction_bins; ++bin) record.directions[bin] += d.share[bin];
}

void divide_curves(double samples, CrackRecord& record) {
  for (auto* curve :
       {&record.shrinkage, &record.broken, &record.fragments, &record.stored, &record.released, &record.directions})
    for (double& x : *curve) x /= samples;
}

void write_springs(const std::filesystem::path& file, const Dried& dried) {
  std::vector<std::array<int, 2>> lines;
  std::vector<double> step(dried.result.broken_at.begin(), dried.result.broken_at.end()), broken;
  for (const Spring& s : dried.network.springs) lines.push_back({s.i, s.j});
  for (const double at : step) broken.push_back(at > 0);
  write_lines_vtu(file, dried.network.X, dried.result.displacement, lines,
                  {{"stretch", dried.result.stretch}, {"broken", broken}, {"step_of_breaking", step}});
}

}  // namespace

FractureSamples run_fracture_samples(const PreparedCase& prepared, const Lattice& lattice, std::size_t number,
                                     const IsotropicMaterial& material, const std::filesystem::path& vtu) {
  const Fracture& f = *prepared.experiment.fracture;
  const std::string& label = prepared.experiment.models[number].label;
  FractureSamples samples;
  for (int sample = 0; sample < f.seeds; ++sample) {
    progress::phase(
        fmt::format("{} on {} cells, sample {} of {}", label, cells_text(lattice.cells, " x "), sample + 1, f.seeds));
    ModelParameters parameters = prepared.models[number];
    parameters.random.seed = f.seed + sample;
    Run& run = samples.runs.emplace_back();
    run.kind = "msm";
    run.kinematics = "linear";
    try {
      const Dried dried = dry(prepared, lattice, parameters, material, f.seed + sample, run);
      samples.scalars.push_back(measures_of(dried));
      add_curves(dried, samples.cracks);
      if (samples.scalars.size() > 1) continue;
      samples.cracks.svg = picture_of(dried, f);
      if (!vtu.empty()) write_springs(vtu, dried);
    } catch (const InputError&) {
      throw;
    } catch (const std::exception& e) {  // no network of this seed, or no equilibrium
      run.message = e.what();
    }
  }
  if (!samples.scalars.empty()) divide_curves(static_cast<double>(samples.scalars.size()), samples.cracks);
  return samples;
}

}  // namespace springproof
