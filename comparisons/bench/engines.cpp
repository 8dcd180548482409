#include "comparisons/bench/engines.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "comparisons/bench/engine_motion.h"
#include "comparisons/bench/engine_ours.h"
#include "comparisons/bench/engine_reference.h"
#include "comparisons/bench/interrupt.h"
#include "comparisons/bench/motion.h"
#include "msm/dynamics/time_step.h"
#include "msm/statics/equilibrium.h"
#include "problem/system/streams.h"

namespace springproof::bench {
namespace {

constexpr double spin_rate = 2;        // [rad/s]
constexpr double tip_speed = 0.1;      // [m/s]: 0.05 m at the first frequency
constexpr double vibration_time = 24;  // [s]: seven periods
constexpr const char* our_models[] = {"msm_18", "hybmss", "hybmss_bt", "hybmss_avg"};

/// How the bar is loaded and brought to rest: the damping is near the critical of the motion that the load causes.
struct Settling {
  BarLoad load;
  const char* quantity;
  double damping, duration;  ///< [1/s], [s]
  double frequency;          ///< about that of the motion [Hz]
};
constexpr Settling gravity = {BarLoad::gravity, "tip", 2.4, 9, 0.3}, torque = {BarLoad::torque, "twist", 8, 3, 1.2},
                   pressure = {BarLoad::pressure, "volume change", 8, 3, 2};

std::vector<std::string> names_of_set_ups() {
  std::vector<std::string> names;
  for (const EngineSetUp& s : engine_set_ups()) names.push_back(s.name);
  return names;
}

/// Whether `part` occurs in `name`, in capitals or not.
bool has_part(const std::string& name, const std::string& part) {
  const auto same = [](unsigned char a, unsigned char b) { return std::tolower(a) == std::tolower(b); };
  return std::search(name.begin(), name.end(), part.begin(), part.end(), same) != name.end();
}

std::string size_of(const Cells& c) { return fmt::format("{}x{}x{}", c[0], c[1], c[2]); }

/// Mean speed at the end, as a share of the mean displacement's that the motion would still make.
double unrest(const EngineAnswer& a, const EngineBar& bar, double frequency) {
  const double speed = std::sqrt(2 * a.samples.back().kinetic_energy / bar.mass.sum());
  const NodalVectors u = a.x - bar.mesh.nodes;
  return speed / (2 * std::numbers::pi * frequency) /
         std::sqrt(u.rowwise().squaredNorm().dot(bar.mass) / bar.mass.sum());
}

class EngineBench {
 public:
  EngineBench(const BenchOptions& options, Findings& findings, EngineFindings& out)
      : options_(options), findings_(findings), out_(out) {
    for (const EngineSetUp& s : engine_set_ups())
      if (has_part(s.name, options.engine)) wanted_.push_back(s);
    if (wanted_.empty())
      throw InputError(fmt::format("--engine: no set-up has '{}' in its name (allowed: a part of {})", options.engine,
                                   fmt::join(names_of_set_ups(), "; ")));
    out.quick = options.quick;
  }

  void run() {
    say_what_is_missing();
    ruler();
    for (const double nu : ratios()) energies(nu);
    for (const double nu : ratios()) statics(coarse_, nu, {gravity}, true);
    if (options_.quick) return;
    for (const double nu : ratios()) statics(coarse_, nu, {torque, pressure}, false);
    for (const double nu : ratios()) statics(fine_, nu, {gravity, torque, pressure}, nu == 0.25);
    dependence();
    motion();
    for (EngineRuns* runs : {&coarse_, &fine_}) cost(*runs);
  }

 private:
  std::vector<double> ratios() const { return {0.0, 0.25, 0.45}; }

  void say_what_is_missing() {
    std::vector<EngineSetUp> there;
    std::map<std::string, std::string> words;
    for (const EngineSetUp& s : wanted_) {
      const std::string missing = missing_for(s.adapter);
      if (missing.empty())
        there.push_back(s);
      else
        words[s.adapter] = fmt::format("{}: not measured: {}", s.name.substr(0, s.name.find(',')), missing);
    }
    for (const auto& [adapter, line] : words) out_.not_measured.push_back(line);
    wanted_ = there;
  }

  void say(const std::string& engine, const std::string& what, const EngineRuns& runs) const {
    to_stderr("engines: {}, {}, {} ...\n", engine, what, size_of(runs.bar().cells));
  }

  const ReferenceValue& reference(const std::string& quantity, double nu) {
    const std::string key = fmt::format("{}, nu = {:g}", quantity, nu);
    if (const auto known = out_.references.find(key); known != out_.references.end()) return known->second;
    to_stderr("engines: finite element reference, {} ...\n", key);
    const BarLoad load = quantity == "twist"           ? BarLoad::torque
                         : quantity == "volume change" ? BarLoad::pressure
                                                       : BarLoad::gravity;
    return out_.references[key] = quantity == "frequency" ? bar_frequency(nu) : bar_reference(load, nu);
  }

  static EngineTask task_of(const EngineSetUp::Step& step) {
    EngineTask task;
    task.time_step = step.dt;
    task.iterations = step.iterations;
    task.integrator = step.integrator;
    return task;
  }

  EngineResult result_of(const std::string& engine, const std::string& quantity, const EngineRuns& runs, double nu,
                         const EngineTask& task) const {
    return {engine, quantity, size_of(runs.bar().cells), nu, task.time_step, task.iterations, task.integrator};
  }

  void add(EngineResult result, double value, const ReferenceValue& truth, double unrest_share) {
    result.value = value;
    result.error = value / truth.value - 1;
    result.uncertainty = std::hypot(truth.uncertainty / std::abs(truth.value), unrest_share) * value / truth.value;
    out_.results.push_back(std::move(result));
  }

  /// The answer; nothing, with a result and a row that say so, if there is none to be believed.
  std::optional<EngineAnswer> answer(const EngineSetUp& s, EngineRuns& runs, const EngineResult& result,
                                     const EngineTask& task) {
    try {
      EngineAnswer a = runs.run(s, result.poisson_ratio, task);
      out_.versions[s.adapter] = a.engine;
      if (!a.burst) return a;
      out_.results.push_back(result);
      out_.results.back().why_not = "burst";
    } catch (const Interrupted&) {
      throw;
    } catch (const std::exception& e) {
      out_.results.push_back(result);
      out_.results.back().why_not = e.what();
      BenchRow row{"engines", s.name, result.cells, result.quantity};
      row.ok = false;
      row.note = e.what();
      findings_.rows.push_back(row);
    }
    return {};
  }

  // ---- the ruler: our springs, stepped by an adapter, end where the library's solver says

  void ruler() {
    if (!missing_for("springs").empty()) return;
    const EngineSetUp springs{
        "springs of the export", "springs", "edges", EngineSetUp::File::edges, false, false, true, {}};
    EngineTask task;
    task.iterations = 4;
    task.forces = forces_of(BarLoad::gravity, coarse_.bar());
    task.damping = 3.6, task.duration = 14;
    say(springs.name, "against msm_18", coarse_);
    const EngineResult result = result_of(springs.name, "ruler", coarse_, 0.25, task);
    const auto a = answer(springs, coarse_, result, task);
    if (!a) return;
    const MassSpringModel model = model_of_bar("msm_18", coarse_.bar(), 0.25);
    const double known = finite_tip(model, coarse_.bar());
    const double off =
        std::abs(measure_of(BarLoad::gravity, coarse_.bar(), a->x - coarse_.bar().mesh.nodes) / known - 1);
    BenchRow row{"engines", "the ruler: msm_18's springs by an adapter", result.cells, "relative difference", off};
    row.target = at_most(1e-6);
    findings_.rows.push_back(row);
  }

  // ---- energies of prescribed fields

  void add_energies(const EngineResult& like, const std::vector<TestField>& fields,
                    const std::vector<NodalVectors>& f) {
    for (std::size_t i = 0; i < f.size(); ++i) {
      EngineResult r = like;
      r.quantity += ", " + fields[i].name;
      r.value = -flat(f[i]).dot(flat(fields[i].u)) / 2 / fields[i].energy;
      r.error = r.value - 1;
      out_.results.push_back(r);
    }
  }

  void energies(double nu) {
    const std::vector<TestField> fields = test_fields(coarse_.bar(), bar_material(nu));
    EngineTask task;
    task.pinned = false;
    for (const TestField& field : fields) task.fields.push_back(field.u);
    for (const EngineSetUp& s : wanted_) {
      if (!s.gives_forces || (nu != 0.25 && !s.any_poisson_ratio)) continue;
      say(s.name, fmt::format("energies, nu = {:g}", nu), coarse_);
      task.integrator = s.steps.front().integrator;
      const EngineResult result = result_of(s.name, "energy", coarse_, nu, task);
      if (const auto a = answer(s, coarse_, result, task)) add_energies(result, fields, a->forces);
    }
    for (const char* name : our_models) {
      if (nu != 0.25 && std::string(name) == "msm_18") continue;
      EngineResult result = result_of(name, "energy", coarse_, nu, task);
      result.ours = true;
      add_energies(result, fields, run_ours(model_of_bar(name, coarse_.bar(), nu), coarse_.bar(), task).forces);
    }
  }

  // ---- equilibria

  /// One equilibrium of one engine; @return its error.
  std::optional<double> settle(const EngineSetUp& s, EngineRuns& runs, double nu, const Settling& how, EngineTask task,
                               const std::string& quantity) {
    const ReferenceValue& truth = reference(how.quantity, nu);
    task.damping = how.damping, task.duration = how.duration, task.free = 0.3;
    const EngineResult result = result_of(s.name, quantity, runs, nu, task);
    const auto a = answer(s, runs, result, task);
    if (!a) return {};
    const double value = measure_of(how.load, runs.bar(), a->x - runs.bar().mesh.nodes);
    add(result, value, truth, unrest(*a, runs.bar(), how.frequency));
    return out_.results.back().error;
  }

  EngineTask recommended(const EngineSetUp& s, EngineRuns& runs) const {
    EngineTask task = task_of(s.steps.front());
    if (task.iterations == 0) task.iterations = runs.exported_substeps(task.time_step);
    return task;
  }

  void statics(EngineRuns& runs, double nu, const std::vector<Settling>& loads, bool own_gravity) {
    for (const Settling& how : loads) {
      const std::string what = fmt::format("{}, nu = {:g}", how.quantity, nu);
      double lattice = 0;
      for (const char* name : our_models) {
        if (nu != 0.25 && std::string(name) == "msm_18") continue;
        EngineResult result = result_of(name, how.quantity, runs, nu, {});
        result.ours = true, result.time_step = 0;
        const NodalVectors u = equilibrium_of_bar(model_of_bar(name, runs.bar(), nu), runs.bar(), how.load);
        add(result, measure_of(how.load, runs.bar(), u), reference(how.quantity, nu), 0);
        if (std::string(name) == "msm_18") lattice = *out_.results.back().error;
      }
      for (const EngineSetUp& s : wanted_) {
        if (nu != 0.25 && !s.any_poisson_ratio) continue;
        say(s.name, what, runs);
        EngineTask task = recommended(s, runs);
        task.forces = forces_of(how.load, runs.bar());
        const auto error = settle(s, runs, nu, how, task, how.quantity);
        if (error && s.adapter == "jolt" && how.load == BarLoad::gravity) off_its_lattice(s, runs, *error, lattice);
        if (how.load != BarLoad::gravity || !own_gravity || !s.own_masses) continue;
        task.forces.resize(0, 3);
        task.gravity = bar_gravity;
        settle(s, runs, nu, how, task, "tip under its own gravity");
      }
    }
  }

  void off_its_lattice(const EngineSetUp& s, const EngineRuns& runs, double error, double lattice) {
    BenchRow row{"engines", s.name + " off its lattice", size_of(runs.bar().cells), "points of the tip",
                 100 * std::abs(error - lattice)};
    row.target = at_most(3);
    row.note = fmt::format("{:+.1f} % beside msm_18's {:+.1f} %", 100 * error, 100 * lattice);
    findings_.rows.push_back(row);
  }

  void dependence() {
    for (const EngineSetUp& s : wanted_) {
      double low = 1e300, high = -1e300;
      for (const EngineSetUp::Step& step : s.steps) {
        if (step.iterations == 0) continue;
        EngineTask task = task_of(step);
        say(s.name, fmt::format("tip at dt = 1/{:.0f}, {} iterations", 1 / step.dt, step.iterations), coarse_);
        task.forces = forces_of(BarLoad::gravity, coarse_.bar());
        const auto error = settle(s, coarse_, 0.25, gravity, task, "tip by step");
        if (error) low = std::min(low, *error), high = std::max(high, *error);
      }
      EngineResult result = result_of(s.name, "dependence", coarse_, 0.25, {});
      result.time_step = 0, result.value = high - low;
      if (high >= low) out_.results.push_back(result);
    }
  }

  // ---- motion

  void add_motion(const EngineResult& like, const char* plane, const std::vector<EngineSample>& samples,
                  const Vec3& d) {
    EngineResult f = like, damping = like;
    f.quantity = fmt::format("frequency, {}", plane), damping.quantity = fmt::format("damping, {}", plane);
    if (const auto v = vibration_of(samples, d)) {
      damping.value = v->damping;
      out_.results.push_back(damping);
      add(f, v->frequency, reference("frequency", 0.25), 0);
    } else {
      f.why_not = "no clean period";
      out_.results.push_back(f);
    }
  }

  /// `run` gives the motion of a task.
  template <class Run>
  void motion_of(const EngineResult& like, EngineTask task, const Run& run) {
    const double half = std::sqrt(0.5);
    const std::pair<const char*, Vec3> planes[] = {{"y + z", {0, half, half}}, {"y - z", {0, half, -half}}};
    task.duration = vibration_time;
    for (const auto& [plane, d] : planes) {
      task.velocities = bending_velocities(coarse_.bar(), d, tip_speed);
      if (const std::optional<EngineAnswer> a = run(task)) add_motion(like, plane, a->samples, d);
    }
    task.pinned = false;
    task.velocities = spin_velocities(coarse_.bar(), spin_rate);
    task.duration = 4 * 2 * std::numbers::pi / spin_rate;
    const std::optional<EngineAnswer> a = run(task);
    if (!a) return;
    EngineResult spin = like;
    spin.quantity = "spin kept", spin.value = spin_kept(a->samples);
    out_.results.push_back(spin);
  }

  void motion() {
    for (const EngineSetUp& s : wanted_)
      for (const EngineSetUp::Step& step : s.steps) {
        if (!step.motion || step.iterations == 0) continue;
        const EngineTask task = task_of(step);
        say(s.name, fmt::format("motion at dt = 1/{:.0f}, {}", 1 / step.dt, step.integrator), coarse_);
        const EngineResult like = result_of(s.name, "motion", coarse_, 0.25, task);
        motion_of(like, task, [&](const EngineTask& t) { return answer(s, coarse_, like, t); });
      }
    for (const char* name : our_models) {
      const MassSpringModel model = model_of_bar(name, coarse_.bar(), 0.25);
      say(name, "motion", coarse_);
      EngineResult like = result_of(name, "motion", coarse_, 0.25, {});
      like.ours = true, like.integrator = "explicit";
      motion_of(like, {}, [&](const EngineTask& t) -> std::optional<EngineAnswer> {
        if (!t.pinned && model.small_displacements_only) return {};  // no four turns
        return run_ours(model, coarse_.bar(), t);
      });
    }
  }

  // ---- cost: a second without anything but the engine's own gravity

  void cost(EngineRuns& runs) {
    const double nodes = double(runs.bar().mass.size());
    for (const EngineSetUp& s : wanted_) {
      say(s.name, "cost", runs);
      EngineTask task = recommended(s, runs);
      task.gravity = bar_gravity, task.duration = 1;
      EngineResult result = result_of(s.name, "cost", runs, 0.25, task);
      const auto a = answer(s, runs, result, task);
      if (!a) continue;
      result.value = 1e6 * a->seconds / double(a->steps) / nodes;
      out_.results.push_back(result);
    }
    for (const char* name : our_models) {
      const MassSpringModel model = model_of_bar(name, runs.bar(), 0.25);
      const auto kernel = fastest_motion(model);
      EngineResult result = result_of(name, "cost", runs, 0.25, {});
      result.ours = true;
      result.time_step = 0.9 * safe_time_step(model, bar_material(0.25).density);
      result.value = 1e6 * least_seconds({kernel->advance})[0] / nodes;
      out_.results.push_back(result);
    }
  }

  const BenchOptions& options_;
  Findings& findings_;
  EngineFindings& out_;
  std::vector<EngineSetUp> wanted_;
  EngineRuns coarse_{{8, 2, 2}}, fine_{{16, 4, 4}};
};

}  // namespace

void bench_engines(const BenchOptions& options, Findings& findings, EngineFindings& engines) {
  EngineBench(options, findings, engines).run();
}

}  // namespace springproof::bench
