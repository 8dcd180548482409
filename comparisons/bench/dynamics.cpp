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
  const BenchOptions& options;
  const Machine& machine;
  Findings& findings;
  bool wide;  ///< the processor has AVX-512
  TimerOptions timer;

  double target(double avx512, double avx2) const { return wide ? avx512 : avx2; }
};

void progress(const std::string& what, const std::string& size) { to_stderr("dynamics: {}, {} ...\n", what, size); }

double ns_per_spring(const TimedStep& motion, double seconds) { return 1e9 * seconds / double(motion.springs); }

BenchRow speed_row(const Context& c, const std::string& what, const std::string& size, const TimedStep& motion,
                   double seconds, const std::string& baseline, double baseline_seconds, Target target) {
  const double to_ns = 1e9 / double(motion.springs);
  return {"dynamics",
          what,
          size,
          per_spring,
          to_ns * seconds,
          baseline,
          to_ns * baseline_seconds,
          target,
          usage_of(motion, seconds, c.machine),
          motion.how};
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
  if (lammps) {
    lammps_seconds = std::min(lammps_seconds, lammps->seconds_per_step(length, runs));
    c.findings.rows.push_back(
        speed_row(c, name + " over LAMMPS", size, *ours, seconds[0], "LAMMPS", lammps_seconds, lammps_target));
  }
  c.findings.rows.push_back(
      speed_row(c, name + " over the plain loop", size, *ours, seconds[0], "plain loop", seconds[1], plain_target));
}

void springs_of_lattices(const Context& c) {
  struct Case {
    int n;
    double avx512, avx2;
  };
  std::vector<Case> cases = {{10, 5, 4}, {15, 7.5, 4}, {20, 7.5, 4}, {30, 8.5, 4}, {63, 8.5, 4}};
  if (c.options.quick) cases.resize(1);
  for (const Case& k : cases) {
    const MassSpringModel model = lattice("hybmss_cf", {k.n, k.n, k.n}, 0.25);
    const Target plain = k.n == 30 ? at_least(c.target(5.5, 2.8)) : Target{};
    against_peers(c, "HybMSS-CF", fmt::format("{}^3", k.n), model, at_least(c.target(k.avx512, k.avx2)), plain);
  }
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

/// Time per step of one model, relative to another's.
void overhead(const Context& c, const std::string& size, const std::string& name, const MassSpringModel& model,
              const std::string& baseline, const MassSpringModel& other, Target target) {
  progress(name + " over " + baseline, size);
  const auto ours = fastest_motion(model), base = fastest_motion(other);
  const std::vector<double> seconds = least_seconds({ours->advance, base->advance}, c.timer);
  c.findings.rows.push_back({"dynamics", name + " over " + baseline, size, "us per step", 1e6 * seconds[0], baseline,
                             1e6 * seconds[1], target, usage_of(*ours, seconds[0], c.machine), ours->how});
}

/// The same model with dashpots in its cells, or a share of consistent mass.
void option_overhead(const Context& c, const std::string& size, const std::string& name, const MassSpringModel& model,
                     const MotionOptions& options, Target target) {
  progress(name, size);
  const auto with = fastest_motion(model, options), without = fastest_motion(model);
  const std::vector<double> seconds = least_seconds({with->advance, without->advance}, c.timer);
  c.findings.rows.push_back({"dynamics", name, size, "us per step", 1e6 * seconds[0], "without", 1e6 * seconds[1],
                             target, usage_of(*with, seconds[0], c.machine), with->how});
}

void overheads(const Context& c) {
  for (const int n : c.options.quick ? std::vector{10} : std::vector{10, 30}) {
    const std::string size = fmt::format("{}^3", n);
    const auto block = [&](const char* name, double nu) { return lattice(name, {n, n, n}, nu); };
    const MassSpringModel hybmss = block("hybmss", 0.3), corrected = block("hybmss_bt", 0.3),
                          averaged = block("hybmss_avg", 0.3), msm = block("msm_18", 0.25);
    overhead(c, size, "HybMSS", hybmss, "HybMSS-CF", block("hybmss_cf", 0.25), at_most(1.35));
    overhead(c, size, "HybMSS", hybmss, "HybMSS-FD", block("hybmss_fd", 0.3), at_most(1.5));
    overhead(c, size, "HybMSS, hourglass correction", corrected, "HybMSS", hybmss, at_most(1.35));
    overhead(c, size, "averaged springs", averaged, "HybMSS", hybmss, at_most(1.6));
    overhead(c, size, "averaged springs, neo-Hooke", lattice("hybmss_avg", {n, n, n}, 0.3, {{"curve", "neo_hooke"}}),
             "HybMSS", hybmss, at_most(1.6));
    const auto viscous = [](const MassSpringModel& model) {
      return MotionOptions{.viscosity = Viscosity::of(model, {youngs_modulus, 0.3, density}, 1e-3)};
    };
    option_overhead(c, size, "HybMSS with viscosity", hybmss, viscous(hybmss), at_most(2));
    option_overhead(c, size, "averaged springs with viscosity", averaged, viscous(averaged), at_most(2));
    const MotionOptions half{.mass_consistency = 0.5};
    option_overhead(c, size, "HybMSS with averaged mass", hybmss, half, at_most(1.6));
    option_overhead(c, size, "HybMSS, hourglass correction, with averaged mass", corrected, half, at_most(1.6));
    option_overhead(c, size, "averaged springs with averaged mass", averaged, half, at_most(1.6));
    overhead(c, size, "eMSM as published", lattice("emsm", {n, n, n}, 0.3, {{"dispersion", "published"}}),
             "MSM of 18 springs", msm, at_most(1.65));
    overhead(c, size, "eMSM, exact nodal volumes", block("emsm", 0.3), "MSM of 18 springs", msm, at_most(1.65));
  }
}

RelaxingCells two_branches(const MassSpringModel& model) {
  return RelaxingCells::of(model, {youngs_modulus, 0.3, density}, {{{0.116, 0.27}, {0.057, 2.6}}});
}

std::vector<int> balls(const BenchOptions& options) {
  return options.quick ? std::vector{500} : std::vector{10000, 100000};
}

void cut_cells(const Context& c) {
  for (const int cells : balls(c.options)) {
    const MassSpringModel model = cut_ball(cells, 0.3);
    const std::string size = fmt::format("{} cells", model.network.cells.size());
    progress("averaged springs in cut cells", size);
    const auto ours = fastest_motion(model), fp32 = fastest_motion(model, {.precision = Precision::float32});
    const TimedStep loops = motion_by_forces(model);
    const auto relaxing = fastest_motion(model, {.relaxation = two_branches(model)});
    const std::vector<double> seconds =
        least_seconds({ours->advance, loops.advance, fp32->advance, relaxing->advance}, c.timer);
    const double to_ns = 1e9 / double(model.network.cells.size());
    const auto row = [&](const char* what, const TimedStep& motion, double own, const char* baseline, double other,
                         Target target) {
      c.findings.rows.push_back({"dynamics", what, size, "ns per cell and step", to_ns * own, baseline, to_ns * other,
                                 target, usage_of(motion, own, c.machine), motion.how});
    };
    row("averaged springs in cut cells", *ours, seconds[0], "loops of the law", seconds[1], at_least(6));
    row("FP32 over FP64, averaged springs in cut cells", *fp32, seconds[2], "FP64", seconds[0], at_least(1.5));
    row("two branches over none, averaged springs in cut cells", *relaxing, seconds[3], "none", seconds[0],
        model.network.cells.size() < 30000 ? at_most(1.3) : Target{});
  }
}

void single_precision(const Context& c, int n) {
  const std::string size = fmt::format("{}^3", n);
  const MassSpringModel model = lattice("hybmss_cf", {n, n, n}, 0.25);
  const auto fp32 = fastest_motion(model, {.precision = Precision::float32}), fp64 = fastest_motion(model);
  if (!fp32) return c.findings.remarks.push_back("no kernel in single precision");
  progress("HybMSS-CF in single precision", size);
  const std::vector<double> seconds = least_seconds({fp32->advance, fp64->advance}, c.timer);
  c.findings.rows.push_back(
      speed_row(c, "FP32 over FP64, HybMSS-CF", size, *fp32, seconds[0], "FP64", seconds[1], at_least(2)));
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
  const Target target = number == 2 ? at_least(limit) : Target{};
  c.findings.rows.push_back({"dynamics",
                             fmt::format("{} threads over one, {}", number, name),
                             size,
                             "us per step, wall",
                             1e6 * seconds[0],
                             "one thread",
                             1e6 * seconds[1],
                             target,
                             {},
                             several->how});
}

void threads(const Context& c) {
  for (const int n : c.options.quick ? std::vector{10} : std::vector{10, 20, 30, 63})
    several_threads(c, "HybMSS-CF", fmt::format("{}^3", n), lattice("hybmss_cf", {n, n, n}, 0.25),
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
  const auto work = [&] {
    const MassSpringModel a = lattice("hybmss_cf", {large, large, large}, 0.25),
                          b = lattice("hybmss_cf", {small, small, small}, 0.25);
    const auto first = fastest_motion(a), second = fastest_motion(b);
    const std::vector<double> seconds = least_seconds({first->advance, second->advance}, c.timer);
    return nlohmann::json{{"large", ns_per_spring(*first, seconds[0])}, {"small", ns_per_spring(*second, seconds[1])}};
  };
  const nlohmann::json a = in_child(work);
  c.findings.rows.push_back({"dynamics", "growth with size, HybMSS-CF", size, per_spring, a.at("large"),
                             fmt::format("{}^3", small), a.at("small"), at_most(1.4)});
}

void memory(const Context& c, int n) {
  const MassSpringModel model = lattice("hybmss_cf", {n, n, n}, 0.25);
  const auto ours = fastest_motion(model);
  const TimedStep plain = plain_motion(model.network);
  c.findings.rows.push_back(
      {"dynamics",
       "memory of HybMSS-CF",
       fmt::format("{}^3", n),
       "bytes per node",
       ours->work.kept / double(ours->nodes),
       "",
       0,
       at_most(80),
       {},
       fmt::format("{}; the plain loop keeps {:.0f}", ours->how, plain.work.kept / double(plain.nodes))});
}

/// The paper's main experiment, for which it prints the time.
void headline(const Context& c) {
  struct Case {
    const char *name, *model;
    double nu, published;
  };
  for (const Case& k : {Case{"paper's 10,000 steps, no correction", "hybmss_cf", 0.25, 2.44},
                        Case{"paper's 10,000 steps, volume correction", "hybmss", 0.3, 5.58}}) {
    const MassSpringModel model = lattice(k.model, {10, 10, 10}, k.nu);
    const auto ours = fastest_motion(model);
    const double seconds = least_seconds({ours->advance}, c.timer)[0];
    c.findings.rows.push_back({"dynamics",
                               k.name,
                               "10^3",
                               "s",
                               steps_of_the_paper * seconds,
                               "Golec et al. (2019), their machine",
                               k.published,
                               {},
                               {},
                               ours->how});
  }
}

}  // namespace

void bench_dynamics(const BenchOptions& options, const Machine& machine, Findings& findings) {
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
