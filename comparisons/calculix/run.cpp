#include "comparisons/calculix/run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <memory>
#include <sstream>

#include "problem/processes/child.h"

namespace springproof::calculix {
namespace {

namespace fs = std::filesystem;

ChildEnd run_in(const fs::path& file, const std::vector<std::string>& arguments, const fs::path& folder,
                double time_limit) {
  return run_child({file, arguments, folder, folder / "log", folder / "log", time_limit});
}

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

/// The first line with *ERROR and the one after it.
std::string error_in(const std::string& log) {
  const auto at = log.find("*ERROR");
  if (at == std::string::npos) return {};
  auto end = log.find('\n', at);
  if (end != std::string::npos) end = log.find('\n', end + 1);
  return fmt::format("{}", fmt::join(words_of(log.substr(at, end == std::string::npos ? end : end - at)), " "));
}

/// Fortran leaves out the E of an exponent of three digits.
double number(std::string text) {
  const auto sign = text.find_first_of("+-", 1);
  if (sign != std::string::npos && text[sign - 1] != 'E') text.insert(sign, 1, 'E');
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (*end != '\0' || text.empty()) throw std::runtime_error(fmt::format("ccx printed '{}' for a number", text));
  return value;
}

void fill_solution(const Deck& deck, const Printed& printed, Solution& solution) {
  const Experiment& e = deck.experiment;
  const NodalVectors support = printed.force - external_loads(deck);
  const bool finite = e.model_kinematics() == Kinematics::finite;
  const NodalVectors arms = finite ? NodalVectors(deck.mesh.nodes + printed.displacement) : deck.mesh.nodes;
  solution.displacement = printed.displacement;
  Field& field = solution.field;
  field.mesh = std::make_shared<Mesh>(deck.linear);
  field.displacement = printed.displacement.topRows(deck.linear.nodes.rows());
  for (const HeldComponent& h : deck.held) {
    const std::string& name = *patch_of(e.loads[h.load]);
    auto at = std::ranges::find_if(field.reactions, [&](const auto& r) { return r.patch == name; });
    if (at == field.reactions.end()) at = field.reactions.insert(at, {name, Vec3::Zero(), Vec3::Zero()});
    const Vec3 force = support(h.node, h.component) * Vec3::Unit(h.component);
    const Vec3 arm = arms.row(h.node).transpose() - centroid(deck.linear, patch(deck.linear, name));
    at->force += force;
    at->torque += arm.cross(force);
    solution.floor.force += print_rounding * std::abs(printed.force(h.node, h.component));
    solution.floor.torque += print_rounding * std::abs(printed.force(h.node, h.component)) * arm.norm();
  }
  const VolumeChange change = volume_change(deck.mesh, printed.displacement);
  field.volume_change = change.exact;
  field.volume_change_first_order = change.first_order;
  solution.floor.displacement = print_rounding * printed.displacement.cwiseAbs().maxCoeff();
  double surface = 0;
  for (const QuadraticPatch& p : deck.mesh.patches) surface += nodal_areas(deck.mesh, p).sum();
  solution.floor.volume = solution.floor.displacement * surface / nodal_volumes(deck.mesh).sum();
  solution.ok = true;
}

/// Reads the blocks of nodes' vectors.
/// @param into where the vectors of a block are wanted, by its first line and the words in that; nullptr: not
template <class Into>
void read_blocks(std::istream& in, Eigen::Index nodes, const Into& into) {
  NodalVectors* to = nullptr;
  for (std::string line; std::getline(in, line);) {
    const std::vector<std::string> word = words_of(line);
    if (line.find(" for set ") != std::string::npos) {
      to = into(line, word);
    } else if (to && word.size() == 4) {
      const long node = std::stol(word[0]) - 1;
      if (node < 0 || node >= nodes) throw std::runtime_error(fmt::format("ccx printed a node {}", node + 1));
      for (int c = 0; c < 3; ++c) (*to)(node, c) = number(word[1 + c]);
    }
  }
}

void fill_frequencies(const Deck& deck, std::istream& dat, Solution& solution) {
  solution.frequencies = read_frequencies(dat);
  solution.ok = static_cast<int>(solution.frequencies.size()) >= deck.task.modes;
  if (!solution.ok) solution.message = fmt::format("ccx found {} modes", solution.frequencies.size());
}

/// A released body's first block is its equilibrium, in a step of one second.
void fill_path(const Deck& deck, std::istream& dat, Solution& solution) {
  const bool released = deck.experiment.dynamics->released;
  std::vector<std::pair<double, NodalVectors>> path = read_path(dat, deck.at_probes);
  if (released)
    path.erase(path.begin(), std::ranges::find_if(path, [](const auto& at) { return at.first > 1 - 1e-6; }));
  else
    path.insert(path.begin(), {0, NodalVectors::Zero(deck.at_probes.rows(), 3)});
  if (static_cast<int>(path.size()) != deck.task.steps + 1) {
    solution.message = path.empty() ? "ccx printed no equilibrium to start from"
                                    : fmt::format("ccx made {} steps of {}", path.size() - 1, deck.task.steps);
    return;
  }
  for (int i = 0; i <= deck.task.steps; ++i) {
    solution.time.push_back(deck.experiment.dynamics->duration * i / deck.task.steps);
    solution.path.push_back(path[i].second);
  }
  solution.ok = true;
}

}  // namespace

fs::path program() { return program_on_path("ccx"); }

std::string version() {
  const fs::path file = program();
  if (file.empty()) return {};
  const TemporaryFolder folder;
  run_in(file, {"-v"}, folder.path, 10);
  const std::string text = text_of_file(folder.path / "log");
  const auto at = text.find("Version ");
  return at == std::string::npos ? "of an unknown version"
                                 : text.substr(at + 8, text.find_first_of(" \n", at + 8) - at - 8);
}

Printed read_dat(std::istream& in, Eigen::Index nodes) {
  const double missing = std::numeric_limits<double>::quiet_NaN();
  Printed printed{NodalVectors::Constant(nodes, 3, missing), NodalVectors::Zero(nodes, 3), 0};
  read_blocks(in, nodes, [&](const std::string& line, const std::vector<std::string>& word) -> NodalVectors* {
    if (word[0] == "forces" && line.find(" HELD_NODES ") != std::string::npos) return &printed.force;
    if (word[0] != "displacements" || line.find(" ALL_NODES ") == std::string::npos) return nullptr;
    printed.time = number(word.back());
    return &printed.displacement;
  });
  if (!printed.displacement.allFinite()) throw std::runtime_error("ccx printed no displacement for some nodes");
  return printed;
}

std::vector<std::pair<double, NodalVectors>> read_path(std::istream& in, const NodalWeights& at_probes) {
  std::vector<std::pair<double, NodalVectors>> path;
  NodalVectors u = NodalVectors::Zero(at_probes.cols(), 3);  // those of other nodes stay 0
  const auto end_block = [&] {
    if (!path.empty()) path.back().second = at_probes * u;
  };
  read_blocks(in, u.rows(), [&](const std::string& line, const std::vector<std::string>& word) -> NodalVectors* {
    end_block();
    if (word[0] != "displacements" || line.find(" AT_PROBES ") == std::string::npos) return nullptr;
    path.emplace_back(number(word.back()), NodalVectors());
    return &u;
  });
  end_block();
  return path;
}

std::vector<double> read_frequencies(std::istream& in) {
  std::vector<double> frequencies;
  bool table = false;
  for (std::string line; std::getline(in, line);) {
    if (line.find("E I G E N V A L U E") != std::string::npos) table = true;
    if (line.find("P A R T I C I P A T I O N") != std::string::npos) break;
    const std::vector<std::string> word = words_of(line);
    if (table && word.size() == 5 && word[0] == std::to_string(frequencies.size() + 1))
      frequencies.push_back(number(word[3]));
  }
  return frequencies;
}

Solution solve(const Deck& deck, double time_limit) {
  const fs::path file = program();
  if (file.empty()) throw std::runtime_error("ccx is not on PATH");
  const TemporaryFolder folder;
  std::ofstream out(folder.path / "case.inp");
  write(deck, out);
  out.close();
  if (!out) throw std::runtime_error(fmt::format("cannot write into {}", folder.path.string()));
  const ChildEnd end = run_in(file, {"-i", "case"}, folder.path, time_limit);
  Solution solution;
  solution.seconds = end.seconds;
  const std::string log = text_of_file(folder.path / "log"), error = error_in(log);
  if (end.kind != ChildEnd::exited)
    solution.message = "ccx " + words_for(end, time_limit);
  else if (!error.empty())
    solution.message = "ccx: " + error;
  else if (log.find("using the iterative solver") != std::string::npos)
    solution.message = "this ccx uses an iterative solver, which stops too early";
  if (!solution.message.empty()) return solution;
  std::ifstream dat(folder.path / "case.dat");
  try {
    if (deck.task.modes > 0)
      fill_frequencies(deck, dat, solution);
    else if (deck.task.steps > 0)
      fill_path(deck, dat, solution);
    if (deck.task.modes > 0 || deck.task.steps > 0) return solution;
    const Printed printed = read_dat(dat, deck.mesh.nodes.rows());
    if (printed.time < deck.steps * (1 - 1e-6))
      solution.message = fmt::format("ccx stopped at {:.4g} % of the load", 100 * printed.time / deck.steps);
    else
      fill_solution(deck, printed, solution);
  } catch (const std::exception& e) {  // what it printed is no number
    solution.message = e.what();
  }
  return solution;
}

}  // namespace springproof::calculix
