#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "comparisons/bench/baselines.h"
#include "comparisons/bench/benches.h"
#include "comparisons/bench/bodies.h"
#include "comparisons/bench/interrupt.h"
#include "comparisons/bench/motion.h"
#include "problem/system/streams.h"

namespace springproof::bench {
namespace {

constexpr const char* per_spring = "ns per spring and step";
constexpr double steps_of_the_paper = 10000;

struct Context {
  const Options& options;
  const Machine& machine;
  Findings& findings;
  bool wide;  ///< the processor has AVX-512
  TimerOptions timer;

  double target(double avx512, double avx2) const { return wide ? avx512 : avx2; }

  /// A row of two times of a step [s], which in `unit` are `factor` as much.
  void add(const std::string& what, const std::string& size, const std::string& unit, double factor,
           const TimedStep& ours, double seconds, const std::string& baseline, double others, Target target) const {
    findings.rows.push_back({"dynamics", what, size, unit, factor * seconds, baseline, factor * others, target,
                             usage_of(ours, seconds, machine), ours.how});
  }
};

void progress(const std::string& what, const std::string& size) { to_stderr("dynamics: {}, {} ...\n", what, size); }

double ns_per_spring(const TimedStep& motion) { return 1e9 / double(motion.springs); }

MassSpringModel cube(const std::string& name, int n, double poisson_ratio) {
  return lattice(name, {n, n, n}, poisson_ratio);
}

/// Largest difference of LAMMPS' forces from ours, over the largest force.
double force_difference(const Lammps& lammps, const Network& network) {
  const NodalVectors ours = forces({network, {Springs{}}}, moved(network));
  return (lammps.forces() - ours).cwiseAbs().maxCoeff() / ours.cwiseAbs().maxCoeff();
}

/// The springs of a model against LAMMPS and the plain loop, side by side; LAMMPS before and after.
void against_peers(const Context& c, const std::string& name, const std::string& size, const MassSpringModel& model,
                   Target lammps_target, Target plain_target) {
  progress(name, size);
  const auto ours = fastest_motion(model);
  const TimedStep plain = plain_motion(model.network);
  std::optional<Lammps> lammps;
  double lammps_seconds = 0;
  const double length = c.options.quick ? 0.1 : 0.5;
  const int runs =
      c.options.quick || model.network.springs.size() > 500000 ? 1 : 3;  // large ones take LAMMPS long to read
  if (Lammps::available()) {
    lammps.emplace(model.network);
    if (const double off = force_difference(*lammps, model.network); !(off < 1e-9))
      throw std::runtime_error(fmt::format("LAMMPS computes other forces than we do: {:.1e} of the largest", off));
    lammps_seconds = lammps->seconds_per_step(length, runs);
  }
  const std::vector<double> seconds = least_seconds({ours->advance, plain.advance}, c.timer);
  const double to_ns = ns_per_spring(*ours);
  if (lammps)
    c.add(name + " over LAMMPS", size, per_spring, to_ns, *ours, seconds[0], "LAMMPS",
          std::min(lammps_seconds, lammps->seconds_per_step(length, runs)), lammps_target);
  c.add(name + " over the plain loop", size, per_spring, to_ns, *ours, seconds[0], "plain loop", seconds[1],
        plain_target);
}

void springs_of_lattices(const Context& c) {
  struct Case {
    int n;
    double avx512, avx2;
  };
  std::vector<Case> cases = {{10, 5, 4}, {15, 7.5, 4}, {20, 7.5, 4}, {30, 8.5, 4}, {63, 8.5, 4}};
  if (c.options.quick) cases.resize(1);
  for (const Case& k : cases)
    against_peers(c, "HybMSS-CF", fmt::format("{}^3", k.n), cube("hybmss_cf", k.n, 0.25),
                  at_least(c.target(k.avx512, k.avx2)), k.n == 30 ? at_least(c.target(5.5, 2.8)) : Target{});
}

/// 20,000 nodes fit into the caches of most processors, 300,000 into none.
void random_networks(const Context& c) {
  struct Case {
    int nodes;
    Target lammps, plain;
  };
  std::vector<Case> cases = {{20000, at_least(c.target(2.5, 2)), at_least(c.target(1.7, 1.4))},
                             {100000, {}, {}},
                             {300000, at_least(1.8), at_least(1.3)}};
  if (c.options.quick) cases = {{1000, {}, {}}};
  for (const Case& k : cases)
    against_peers(c, "random network", fmt::format("{} nodes", k.nodes), random_springs(k.nodes), k.lammps, k.plain);
}

/// Time per step of a model, with options, relative to another's.
void overhead(const Context& c, int n, const std::string& what, const MassSpringModel& model,
              const std::string& baseline, const MassSpringModel& other, double most,
              const MotionOptions& options = {}) {
  const std::string size = fmt::format("{}^3", n);
  progress(what, size);
  const auto ours = fastest_motion(model, options), base = fastest_motion(other);
  const std::vector<double> seconds = least_seconds({ours->advance, base->advance}, c.timer);
  c.add(what, size, "us per step", 1e6, *ours, seconds[0], baseline, seconds[1], at_most(most));
}

void overheads(const Context& c) {
  for (const int n : c.options.quick ? std::vector{10} : std::vector{10, 30}) {
    const MassSpringModel hybmss = cube("hybmss", n, 0.3), corrected = cube("hybmss_bt", n, 0.3),
                          averaged = cube("hybmss_avg", n, 0.3), msm = cube("msm_18", n, 0.25);
    overhead(c, n, "HybMSS over HybMSS-CF", hybmss, "HybMSS-CF", cube("hybmss_cf", n, 0.25), 1.35);
    overhead(c, n, "HybMSS over HybMSS-FD", hybmss, "HybMSS-FD", cube("hybmss_fd", n, 0.3), 1.5);
    overhead(c, n, "HybMSS, hourglass correction over HybMSS", corrected, "HybMSS", hybmss, 1.35);
    overhead(c, n, "averaged springs over HybMSS", averaged, "HybMSS", hybmss, 1.6);
    overhead(c, n, "averaged springs, neo-Hooke over HybMSS",
             lattice("hybmss_avg", {n, n, n}, 0.3, {{"curve", "neo_hooke"}}), "HybMSS", hybmss, 1.6);
    const auto viscous = [](const MassSpringModel& model) {
      return MotionOptions{.viscosity = Viscosity::of(model, {youngs_modulus, 0.3, density}, 1e-3)};
    };
    overhead(c, n, "HybMSS with viscosity", hybmss, "without", hybmss, 2, viscous(hybmss));
    overhead(c, n, "averaged springs with viscosity", averaged, "without", averaged, 2, viscous(averaged));
    const MotionOptions half{.mass_consistency = 0.5};
    overhead(c, n, "HybMSS with averaged mass", hybmss, "without", hybmss, 1.6, half);
    overhead(c, n, "HybMSS, hourglass correction, with averaged mass", corrected, "without", corrected, 1.6, half);
    overhead(c, n, "averaged springs with averaged mass", averaged, "without", averaged, 1.6, half);
    overhead(c, n, "eMSM as published over MSM of 18 springs",
             lattice("emsm", {n, n, n}, 0.3, {{"dispersion", "published"}}), "MSM of 18 springs", msm, 1.65);
    overhead(c, n, "eMSM, exact nodal volumes over MSM of 18 springs", cube("emsm", n, 0.3), "MSM of 18 springs", msm,
             1.65);
  }
}

std::vector<int> balls(const Options& options) { return options.quick ? std::vector{500} : std::vector{10000, 100000}; }

void cut_cells(const Context& c) {
  for (const int about : balls(c.options)) {
    const MassSpringModel model = cut_ball(about, 0.3);
    const std::size_t cells = model.network.cells.size();
    const std::string size = fmt::format("{} cells", cells);
    progress("averaged springs in cut cells", size);
    const RelaxingCells two = RelaxingCells::of(model, {youngs_modulus, 0.3, density}, {{{0.116, 0.27}, {0.057, 2.6}}});
    const auto ours = fastest_motion(model), fp32 = fastest_motion(model, {.precision = Precision::float32}),
               relaxing = fastest_motion(model, {.relaxation = two});
    const TimedStep loops = motion_by_forces(model);
    const std::vector<double> seconds =
        least_seconds({ours->advance, loops.advance, fp32->advance, relaxing->advance}, c.timer);
    const auto row = [&](const std::string& what, const TimedStep& motion, double own, const std::string& baseline,
                         double other, Target target) {
      c.add(what + "averaged springs in cut cells", size, "ns per cell and step", 1e9 / double(cells), motion, own,
            baseline, other, target);
    };
    row("", *ours, seconds[0], "loops of the law", seconds[1], at_least(6));
    row("FP32 over FP64, ", *fp32, seconds[2], "FP64", seconds[0], at_least(1.5));
    row("two branches over none, ", *relaxing, seconds[3], "none", seconds[0], cells < 30000 ? at_most(1.3) : Target{});
  }
}

void single_precision(const Context& c, int n) {
  const std::string size = fmt::format("{}^3", n);
  const MassSpringModel model = cube("hybmss_cf", n, 0.25);
  const auto fp32 = fastest_motion(model, {.precision = Precision::float32}), fp64 = fastest_motion(model);
  progress("HybMSS-CF in single precision", size);
  const std::vector<double> seconds = least_seconds({fp32->advance, fp64->advance}, c.timer);
  c.add("FP32 over FP64, HybMSS-CF", size, per_spring, ns_per_spring(*fp32), *fp32, seconds[0], "FP64", seconds[1],
        at_least(2));
}

void several_threads(const Context& c, const std::string& name, const std::string& size, const MassSpringModel& model,
                     double limit) {
  const int number = c.options.threads;
  TimerOptions wall = c.timer;
  wall.clock = Clock::wall;
  wall.budget *= 4;
  wall.sample = 1e-3;    // short enough to find both processors free
  wall.least_steps = 8;  // threads may take steps in turn
  progress(fmt::format("{} on {} threads", name, number), size);
  const auto several = fastest_motion(model, {.threads = number}), one = fastest_motion(model);
  const std::vector<double> seconds = least_seconds({several->advance, one->advance}, wall);
  const double alone = least_seconds({one->advance}, c.timer)[0];
  if (seconds[1] > 1.25 * alone)  // it never had a processor for itself, so two threads never had two
    return c.findings.remarks.push_back(fmt::format(
        "{} threads, {}, {}: not measured, the machine is busy (one thread takes {:.1f} times its CPU time)", number,
        name, size, seconds[1] / alone));
  c.add(fmt::format("{} threads over one, {}", number, name), size, "us per step, wall", 1e6, *several, seconds[0],
        "one thread", seconds[1], number == 2 ? at_least(limit) : Target{});
  c.findings.rows.back().usage.reset();  // which is of one core
}

void threads(const Context& c) {
  for (const int n : c.options.quick ? std::vector{10} : std::vector{10, 20, 30, 63})
    several_threads(c, "HybMSS-CF", fmt::format("{}^3", n), cube("hybmss_cf", n, 0.25),
                    n <= 10   ? 1.3
                    : n <= 20 ? 1.8
                              : 1.9);
  for (const int cells : balls(c.options))
    several_threads(c, "averaged springs in cut cells", fmt::format("about {} cells", cells), cut_ball(cells, 0.3),
                    1.8);
  for (const int nodes : c.options.quick ? std::vector{1000} : std::vector{30000, 300000})
    several_threads(c, "random network", fmt::format("{} nodes", nodes), random_springs(nodes), 1.8);
}

/// In a child process, since its network takes gigabytes.
void growth(const Context& c, int small, int large) {
  const std::string size = fmt::format("{}^3 over {}^3", large, small);
  progress("growth of the cost per spring", size);
  const nlohmann::json ns = in_child([&] {
    const MassSpringModel a = cube("hybmss_cf", large, 0.25), b = cube("hybmss_cf", small, 0.25);
    const auto first = fastest_motion(a), second = fastest_motion(b);
    const std::vector<double> seconds = least_seconds({first->advance, second->advance}, c.timer);
    return nlohmann::json{seconds[0] * ns_per_spring(*first), seconds[1] * ns_per_spring(*second)};
  });
  c.findings.rows.push_back({"dynamics", "growth with size, HybMSS-CF", size, per_spring, ns[0],
                             fmt::format("{}^3", small), ns[1], at_most(1.4)});
}

void memory(const Context& c, int n) {
  const MassSpringModel model = cube("hybmss_cf", n, 0.25);
  const auto ours = fastest_motion(model);
  const TimedStep plain = plain_motion(model.network);
  BenchRow row{"dynamics", "memory of HybMSS-CF", fmt::format("{}^3", n), "bytes per node"};
  row.value = ours->work.kept / double(ours->nodes);
  row.target = at_most(80);
  row.note = fmt::format("{}; the plain loop keeps {:.0f}", ours->how, plain.work.kept / double(plain.nodes));
  c.findings.rows.push_back(row);
}

/// The paper's main experiment, for which it prints the time.
void headline(const Context& c) {
  struct Case {
    const char *name, *model;
    double nu, published;
  };
  for (const Case& k : {Case{"paper's 10,000 steps, no correction", "hybmss_cf", 0.25, 2.44},
                        Case{"paper's 10,000 steps, volume correction", "hybmss", 0.3, 5.58}}) {
    const MassSpringModel model = cube(k.model, 10, k.nu);
    const auto ours = fastest_motion(model);
    BenchRow row{"dynamics", k.name, "10^3", "s"};
    row.value = steps_of_the_paper * least_seconds({ours->advance}, c.timer)[0];
    row.baseline = "Golec et al. (2019), their machine";
    row.baseline_value = k.published;
    row.note = ours->how;
    c.findings.rows.push_back(row);
  }
}

}  // namespace

void bench_dynamics(const Options& options, const Machine& machine, Findings& findings) {
  const bool quick = options.quick;
  const bool wide = machine.widest().instruction_set == "avx512";
  const Context c{options, machine, findings, wide, {quick ? 2e-3 : 5e-3, quick ? 0.05 : 0.5, Clock::thread}};
  if (!Lammps::available()) findings.remarks.push_back("LAMMPS (lmp) is not on PATH: no rows against it");
  springs_of_lattices(c);
  overheads(c);
  random_networks(c);
  cut_cells(c);
  single_precision(c, quick ? 10 : 30);
  threads(c);
  headline(c);
  memory(c, quick ? 10 : 30);
  if (!quick) growth(c, 30, 127);
}

}  // namespace springproof::bench
