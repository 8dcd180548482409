#include "comparisons/bench/lammps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>

#include "comparisons/bench/bodies.h"
#include "comparisons/bench/interrupt.h"
#include "msm/dynamics/time_step.h"

namespace springproof::bench {
namespace {

namespace fs = std::filesystem;

fs::path program() {
  if (const char* given = std::getenv("SPRINGPROOF_LAMMPS")) return given;
  return program_on_path("lmp");
}

/// Assigns the numbers 1, 2, ... to distinct values.
template <class Key>
class Types {
 public:
  int of(const Key& key) {
    const auto [at, is_new] = number_.try_emplace(key, int(values_.size()) + 1);
    if (is_new) values_.push_back(key);
    return at->second;
  }
  const std::vector<Key>& values() const { return values_; }

 private:
  std::map<Key, int> number_;
  std::vector<Key> values_;
};

double longest_spring(const Network& network) {
  double longest = 0;
  for (const Spring& s : network.springs) longest = std::max(longest, s.rest_length);
  return longest;
}

/// Mass of each node; all get the mean if there are more than 64 different masses.
std::vector<double> few_masses(const Network& network) {
  const Eigen::VectorXd all = masses(network, density);
  Types<double> types;
  for (const double m : all) types.of(m);
  if (types.values().size() <= 64) return {all.begin(), all.end()};
  return std::vector<double>(all.size(), all.mean());
}

void write_data(const Network& network, const fs::path& file) {
  const NodalVectors x = moved(network);
  const std::vector<double> mass = few_masses(network);
  Types<double> node_types;
  Types<std::pair<double, double>> bond_types;
  std::string atoms, bonds;
  for (Eigen::Index n = 0; n < x.rows(); ++n)
    fmt::format_to(std::back_inserter(atoms), "{} 1 {} {:.17g} {:.17g} {:.17g}\n", n + 1, node_types.of(mass[n]),
                   x(n, 0), x(n, 1), x(n, 2));
  long number = 0;
  for (const Spring& s : network.springs)
    fmt::format_to(std::back_inserter(bonds), "{} {} {} {}\n", ++number, bond_types.of({s.stiffness, s.rest_length}),
                   s.i + 1, s.j + 1);
  std::string head = fmt::format("springs\n\n{} atoms\n{} atom types\n{} bonds\n{} bond types\n\n", x.rows(),
                                 node_types.values().size(), network.springs.size(), bond_types.values().size());
  for (int c = 0; c < 3; ++c)
    head += fmt::format("{0:.17g} {1:.17g} {2}lo {2}hi\n", x.col(c).minCoeff() - edge, x.col(c).maxCoeff() + edge,
                        "xyz"[c]);
  head += "\nMasses\n\n";
  for (std::size_t i = 0; i < node_types.values().size(); ++i)
    head += fmt::format("{} {:.17g}\n", i + 1, node_types.values()[i]);
  head += "\nBond Coeffs\n\n";  // energy K (r - r0)^2: K is half of the spring constant
  for (std::size_t i = 0; i < bond_types.values().size(); ++i)
    head += fmt::format("{} {:.17g} {:.17g}\n", i + 1, bond_types.values()[i].first / 2, bond_types.values()[i].second);
  std::ofstream out(file);
  out << head << "\nAtoms # bond\n\n" << atoms << "\nBonds\n\n" << bonds;
  if (!out.flush()) throw std::runtime_error("cannot write " + file.string());
}

std::string last_words(const std::string& output) {
  const auto at = output.find("ERROR");
  return at == std::string::npos ? "" : trimmed(output.substr(at, 200));
}

}  // namespace

bool Lammps::available() { return !program().empty(); }

std::string Lammps::version() {
  const TemporaryFolder folder;
  run_child({program(), {"-help"}, folder.path, folder.path / "log", folder.path / "log", 20});
  const std::string text = text_of_file(folder.path / "log");
  const auto at = text.find(" - ");
  return at == std::string::npos ? "LAMMPS" : "LAMMPS " + text.substr(at + 3, text.find('\n', at) - at - 3);
}

Lammps::Lammps(const Network& network)
    : cutoff_(1.5 * longest_spring(network)),
      time_step_(0.25 * safe_time_step({network, {Springs{}}}, density)),
      nodes_(network.nodes()),
      springs_(long(network.springs.size())) {
  write_data(network, folder_.path / "data");
}

double Lammps::seconds_of(const std::string& commands) const {
  std::ofstream(folder_.path / "input") << fmt::format(
      "units lj\natom_style bond\natom_modify sort 0 0.0\nboundary f f f\nnewton on\nspecial_bonds lj/coul 1 1 1\n"
      "bond_style harmonic\nneighbor {0:.6g} bin\ncomm_modify cutoff {0:.6g}\nread_data data\n"
      "neigh_modify every 1000000000 delay 1000000000 check no\ntimestep {1:.10g}\nfix 1 all nve\nthermo "
      "1000000000\n{2}",
      cutoff_, time_step_, commands);
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
