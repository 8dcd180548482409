#include "comparisons/models/motion_reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "comparisons/models/motion_run.h"
#include "comparisons/prepare/sampling.h"
#include "comparisons/reference/reference_grids.h"
#include "comparisons/reference/solve_each.h"
#include "fem_reference/exchange/case_request.h"

namespace springproof {
namespace {

// Elements (Q2) of the finest grid of a block.
constexpr double motion_elements = 512;
constexpr int steps_per_sample = 2;  // an even number

/// Displacements of every probe at every time, one below the other.
NodalVectors at_times(const fem::Solution& s, const std::vector<double>& times) {
  const Eigen::Index probes = s.path.front().rows();
  NodalVectors all(static_cast<Eigen::Index>(times.size()) * probes, 3);
  for (Eigen::Index p = 0; p < probes; ++p)
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<double> values;
      for (const NodalVectors& u : s.path) values.push_back(u(p, axis));
      for (std::size_t i = 0; i < times.size(); ++i)
        all(static_cast<Eigen::Index>(i) * probes + p, axis) = at_time(s.time, values, times[i]);
    }
  return all;
}

/// The history of the probes, from at_times().
HistoryRecord history_of(const Experiment& e, const std::vector<double>& times, const NodalVectors& field) {
  HistoryRecord h;
  h.time = times;
  const auto probes = static_cast<Eigen::Index>(e.probes.size());
  for (Eigen::Index p = 0; p < probes; ++p)
    for (int axis = 0; axis < 3; ++axis) {
      h.names.push_back(fmt::format("displacement.{}.{}", e.probes[p].name, "xyz"[axis]));
      h.units.emplace_back("m");
      std::vector<double>& values = h.values.emplace_back();
      for (std::size_t i = 0; i < times.size(); ++i)
        values.push_back(field(static_cast<Eigen::Index>(i) * probes + p, axis));
    }
  return h;
}

}  // namespace

fem::Request motion_request(const PreparedCase& prepared, const IsotropicMaterial& material) {
  const Experiment& e = prepared.experiment;
  const MotionChoice& motion = *e.dynamics;
  fem::Request request = fem::request_of(e, material);
  request.material = material;
  request.loads = prepared.loads;
  request.points = probe_points(e);
  request.cost = false;
  request.motion = fem::MotionRequest{motion.duration,  motion.damping,  motion.course,
                                      motion.released,  motion.velocity, motion.spin,
                                      motion.viscosity, e.relaxation,    e.reference.energy_momentum};
  const Cells fine =
      e.reference.cells[0] > 0 ? e.reference.cells : divisible_cells(e.body.size, motion_elements, fewest_across(e));
  for (int g = 0; g < 3; ++g) {
    fem::Discretisation grid{divided(fine, 4 >> g), "q2", e.reference.grading};
    if (e.body.is_voxels()) grid = {{prepared.body.uncut[g], 0, 0}, "p2", 1.0, g};
    grid.steps = steps_per_sample * motion.samples;
    request.grids.push_back(grid);
  }
  request.grids.push_back(request.grids[1]);
  request.grids.back().steps /= 2;
  if (e.body.is_voxels()) request.meshes = prepared.body.tetrahedra;
  return request;
}

double at_time(const std::vector<double>& t, const std::vector<double>& u, double time) {
  const auto count = static_cast<long>(t.size()), points = std::min(4L, count);
  const long after = std::ranges::upper_bound(t, time) - t.begin();
  const long first = std::clamp(after - points / 2, 0L, count - points);
  double sum = 0;
  for (long i = first; i < first + points; ++i) {
    double weight = 1;
    for (long j = first; j < first + points; ++j)
      if (j != i) weight *= (time - t[j]) / (t[i] - t[j]);
    sum += weight * u[i];
  }
  return sum;
}

NodalVectors step_correction(const NodalVectors& fine, const NodalVectors& coarse) { return (fine - coarse) / 3; }

namespace {

/// The displacements of the probes in time on three grids.
struct ProbesOnGrids {
  ElementGrids grids;
  std::vector<double> times;
  NodalVectors of_steps;             ///< step_correction(), which the fields have
  std::vector<NodalVectors> fields;  ///< at_times() of each grid
};

/// @param solutions on the three grids, and on the middle one in steps twice as long
ProbesOnGrids probes_on_grids(const std::string& element, std::vector<fem::Solution> solutions) {
  ProbesOnGrids p;
  p.times = solutions[2].time;
  p.of_steps = step_correction(at_times(solutions[1], p.times), at_times(solutions[3], p.times));
  solutions.pop_back();
  p.grids = {element, std::move(solutions)};
  for (const fem::Solution& s : p.grids.grids) p.fields.push_back(at_times(s, p.times) + p.of_steps);
  return p;
}

/// The limits of measured_in_time().
void measure_limits(const PreparedCase& prepared, const ProbesOnGrids& probes, MotionReference& out) {
  const auto measured = [&](const NodalVectors& field) {
    HistoryRecord h = history_of(prepared.experiment, probes.times, field);
    h.probe = out.history.probe;
    return measured_in_time(prepared.experiment, h);
  };
  std::map<std::string, std::vector<double>> values;
  for (const NodalVectors& field : probes.fields)
    for (const auto& [name, value] : measured(field)) values[name].push_back(value);
  for (const auto& [name, uncorrected] : measured(probes.fields[1] - probes.of_steps)) {
    const std::vector<double>& v = values[name];
    if (v.size() < 3) continue;
    ReferenceValue value = extrapolate(v, solver_noise * v[2], {}, ratios_of(probes.grids));
    value.uncertainty +=
        coarse_safety_factor * std::abs(v[1] - uncorrected) + prepared.body.load_spread * std::abs(value.value);
    out.history.measured[name] = value.value;
    out.measured[name] = value;
  }
}

/// What a solution says of itself.
void describe(const fem::Solution& finest, Run& run) {
  run.kinematics = finest.law;
  run.ok = true;
  run.solver = finest.form;
  run.iterations = finest.iterations;
  run.seconds = finest.seconds;
  run.unknowns = finest.unknowns;
  run.memory_MiB = finest.memory_MiB;
}

}  // namespace

MotionReference limit_of_motion(const PreparedCase& prepared, std::vector<fem::Solution> solutions) {
  const Experiment& e = prepared.experiment;
  MotionReference out;
  out.run.cells = solutions[2].grid.cells;
  for (const fem::Solution& s : solutions)
    if (!s.ok) {
      out.run.message = fmt::format("{} cells: {}", cells_text(s.grid.cells, " x "), s.message);
      return out;
    }
  const ProbesOnGrids probes = probes_on_grids(e.body.is_voxels() ? "p2" : "q2", std::move(solutions));
  const ReferenceField limit =
      extrapolate(probes.fields, Eigen::VectorXd::Ones(probes.of_steps.rows()), ratios_of(probes.grids));
  const double norm = probes.fields.back().norm();
  if (!(norm > 0)) {
    out.run.message = "the probes do not move";
    return out;
  }
  out.uncertainty =
      limit.uncertainty + coarse_safety_factor * probes.of_steps.norm() / norm + prepared.body.load_spread;
  const fem::Solution& finest = probes.grids.grids.back();
  out.history = history_of(e, probes.times, limit.displacement);
  out.history.integrator = "midpoint rule, limit of three grids and two steps";
  out.history.time_step = e.dynamics->duration / finest.grid.steps;
  out.history.probe = liveliest(out.history, e.probes.front().name);
  measure_limits(prepared, probes, out);
  out.history.measured["uncertainty"] = out.uncertainty;
  if (!finest.kinetic_energy.empty()) {
    out.history.names.emplace_back("kinetic_energy");
    out.history.units.emplace_back("J");
    out.history.values.push_back(finest.kinetic_energy);
  }
  describe(finest, out.run);
  out.run.message = limit.note;
  return out;
}

MotionReference solve_motion(const PreparedCase& prepared, const IsotropicMaterial& material,
                             const RunKeeper& keeper) try {
  return limit_of_motion(prepared, solve_each(motion_request(prepared, material), keeper));
} catch (const InputError&) {
  throw;
} catch (const std::runtime_error& e) {
  MotionReference none;
  none.run.message = e.what();
  return none;
}

double history_error(const HistoryRecord& model, const HistoryRecord& reference) {
  double squares = 0, of_reference = 0;
  for (const std::string& name : reference.names) {
    if (!name.starts_with("displacement.")) continue;
    const std::vector<double>&u = *series(model, name), &truth = *series(reference, name);
    for (std::size_t i = 0; i < model.time.size(); ++i) {
      if (model.time[i] > reference.time.back() * (1 + 1e-9)) continue;
      const double there = at_time(reference.time, truth, model.time[i]);
      squares += (u[i] - there) * (u[i] - there);
      of_reference += there * there;
    }
  }
  return std::sqrt(squares / of_reference);
}

}  // namespace springproof
