#include "comparisons/bench/lammps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <set>

#include "comparisons/bench/bodies.h"
#include "comparisons/bench/interrupt.h"
#include "msm/dynamics/time_step.h"
#include "msm/exchange/lammps.h"
#include "problem/files/files.h"

namespace springproof::bench {
namespace {

namespace fs = std::filesystem;

fs::path program() {
  if (const char* given = std::getenv("SPRINGPROOF_LAMMPS")) return given;
  return program_on_path("lmp");
}

/// Mass of each node; all get the mean if there are more than 64 different masses.
Eigen::VectorXd few_masses(const Network& network) {
  const Eigen::VectorXd all = masses(network, density);
  if (std::set<double>(all.begin(), all.end()).size() <= 64) return all;
  return Eigen::VectorXd::Constant(all.size(), all.mean());
}

std::string last_words(const std::string& output) {
  const auto at = output.find("ERROR");
  return at == std::string::npos ? "" : trimmed(output.substr(at, 200));
}

}  // namespace

bool Lammps::available() { return !program().empty(); }

Lammps::Lammps(const Network& network) : nodes_(network.nodes()), springs_(long(network.springs.size())) {
  const Eigen::VectorXd mass = few_masses(network);
  const MassSpringModel model{network, {Springs{}}};
  set_up_ = lammps_input(model, mass, "data", 0.25 * safe_time_step(model, density));
  write_file(folder_.path / "data", lammps_data(model, moved(network), mass));
}

double Lammps::seconds_of(const std::string& commands) const {
  write_file(folder_.path / "input", set_up_ + "thermo 1000000000\n" + commands);
  const fs::path log = folder_.path / "output";
  fs::remove(log);
  const ChildEnd end = run_child({program(), {"-in", "input", "-log", "none"}, folder_.path, log, log});
  throw_if_interrupted();
  if (!end.ok()) throw std::runtime_error(fmt::format("lmp {}: {}", words_for(end), last_words(text_of_file(log))));
  return end.seconds;
}

double Lammps::seconds_per_step(double seconds_of_steps, int runs) const {
  const std::string few = "run 1\n";
  double short_run = seconds_of(few), long_run = std::numeric_limits<double>::infinity();
  const long steps = std::max(20L, std::lround(std::max(seconds_of_steps, short_run) / (6e-9 * double(springs_))));
  const std::string many = fmt::format("run {}\n", 1 + steps);
  for (int r = 0; r < runs; ++r) {
    if (r > 0) short_run = std::min(short_run, seconds_of(few));
    long_run = std::min(long_run, seconds_of(many));
  }
  if (!(long_run > short_run))
    throw std::runtime_error(fmt::format("lmp takes no longer for {} steps than for one", 1 + steps));
  return (long_run - short_run) / double(steps);
}

NodalVectors Lammps::forces() const {
  seconds_of("dump 1 all custom 1 forces id fx fy fz\ndump_modify 1 sort id format float %.17g\nrun 0\n");
  std::ifstream in(folder_.path / "forces");
  std::string line;
  while (std::getline(in, line) && !line.starts_with("ITEM: ATOMS")) {
  }
  NodalVectors f(nodes_, 3);
  long id = 0;
  for (long n = 0; n < nodes_; ++n)
    if (!(in >> id >> f(n, 0) >> f(n, 1) >> f(n, 2)) || id != n + 1) throw std::runtime_error("lmp wrote no forces");
  return f;
}

}  // namespace springproof::bench
