#include <fmt/format.h>
#include <sys/resource.h>

#include <nlohmann/json.hpp>

#include "comparisons/bench/benches.h"
#include "comparisons/bench/interrupt.h"
#include "comparisons/calculix/cross_check.h"
#include "comparisons/calculix/run.h"
#include "comparisons/judge/measures.h"
#include "comparisons/judge/reference_value.h"
#include "comparisons/sweep/find_cases.h"
#include "fem_reference/exchange/case_request.h"
#include "fem_reference/exchange/reference.h"
#include "meshes/mesher/mesher.h"
#include "problem/processes/child.h"
#include "problem/system/streams.h"

namespace springproof::bench {
namespace {

using Json = nlohmann::json;

Target target_of(const Json& figures, const std::string& what) {
  const Json targets = figures.value("targets", Json::object());
  if (!targets.contains(what)) return {};
  const Json& t = targets.at(what);
  return t.contains("at_least") ? at_least(t.at("at_least")) : at_most(t.at("at_most"));
}

BenchRow run_row(const Json& run) {
  BenchRow row{"fem", run.at("name"), fmt::format("{}^3", run.at("cells").get<int>()), "CPU s", run.at("cpu_seconds")};
  row.ok = run.at("ok");
  row.note = fmt::format("{}, nu = {:g}, {} unknowns, {} iterations, {:.0f} MiB", run.at("form").get<std::string>(),
                         run.at("poisson_ratio").get<double>(), run.at("unknowns").get<long>(),
                         run.at("iterations").get<int>(), run.at("memory_MiB").get<double>());
  return row;
}

/// A case and its grids: numbers of cells across the body.
struct Contest {
  std::string name, file;
  Cells shape;  ///< cells for one across
  int calculix;
  std::vector<int> ours;  ///< ascending; the last has at least the unknowns of CalculiX's
  std::array<int, 3> truth;
};

const std::vector<Contest> contests = {
    {"compressed cube", "cost/compression", {1, 1, 1}, 16, {4, 6, 8, 10, 12, 14}, {8, 16, 32}},
    {"bending beam", "golec_2019/bending", {6, 1, 1}, 8, {2, 3, 4, 5, 6, 7}, {4, 8, 16}},
};
constexpr int cells_of_comparison = 4;

struct Entry {
  long unknowns = 0;
  double seconds = 0;
  NodalVectors displacement;  ///< at the points of comparison [m]
};

/// `factor` cells where `shape` has one.
Cells times(const Cells& shape, int factor) { return {shape[0] * factor, shape[1] * factor, shape[2] * factor}; }

/// CPU seconds of all child processes that have ended.
double seconds_of_children() {
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// One case of one material, and the points at which the programs are compared: the nodes of a coarse grid.
struct Question {
  Experiment experiment;
  IsotropicMaterial material;
  Mesh coarse;

  explicit Question(const Contest& c)
      : experiment(read_experiment(find_case(c.file))),
        material(at_wanted(experiment, 0.25).materials.front()),
        coarse(block_mesh(experiment.body.size, times(c.shape, cells_of_comparison))) {}
};

Entry by_calculix(const Question& q, const Cells& cells) {
  const Mesh mesh = block_mesh(q.experiment.body.size, cells);
  const calculix::Deck deck = calculix::make_deck(q.experiment, q.material, mesh);
  const calculix::Solution s = calculix::solve(deck, 600);
  throw_if_interrupted();
  if (!s.ok) throw std::runtime_error(s.message);
  return {3 * deck.mesh.nodes.rows(), s.seconds,
          calculix::weights_at(deck.mesh, deck.linear, q.coarse.nodes) * s.displacement};
}

Entry by_us(const Question& q, const Cells& cells) {
  fem::Request request = fem::request_of(q.experiment, q.material);
  request.points = q.coarse.nodes;
  request.grids.push_back({cells});
  const double before = seconds_of_children();
  const fem::Solution s = fem::solve(request).front();
  throw_if_interrupted();
  if (!s.ok) throw std::runtime_error(s.message);
  return {s.degrees_of_freedom, seconds_of_children() - before, s.displacement};
}

void run(const Contest& contest, Findings& findings) try {
  to_stderr("{}: CalculiX and our finite elements ...\n", contest.name);
  const Question q(contest);
  const Eigen::VectorXd volumes = nodal_volumes(q.coarse);
  std::vector<NodalVectors> fine;
  for (const int factor : contest.truth) fine.push_back(by_us(q, times(contest.shape, factor)).displacement);
  const ReferenceField truth = extrapolate(fine, volumes);
  const auto error = [&](const Entry& e) { return displacement_error(e.displacement, truth.displacement, volumes); };

  const Entry theirs = by_calculix(q, times(contest.shape, contest.calculix));
  const auto row = [&](const char* what, const Entry& ours) {
    BenchRow r{"fem", fmt::format("{}, {}", contest.name, what), "", "CPU s", ours.seconds, "CalculiX", theirs.seconds};
    r.size = fmt::format("{}, {}", ours.unknowns, theirs.unknowns);
    r.target = at_least(4);
    r.note = fmt::format("Q2 and C3D20 of CalculiX {}; errors {:.2g} and {:.2g} %, +- {:.1g}", calculix::version(),
                         100 * error(ours), 100 * error(theirs), 100 * truth.uncertainty);
    findings.rows.push_back(r);
  };
  std::optional<Entry> as_exact;
  for (const int factor : contest.ours) {
    const Entry ours = by_us(q, times(contest.shape, factor));
    if (!as_exact && error(ours) <= error(theirs)) as_exact = ours;
    if (factor == contest.ours.back()) row("unknowns as many", ours);
  }
  if (as_exact) row("error no larger", *as_exact);
} catch (const Interrupted&) {
  throw;
} catch (const std::runtime_error& e) {
  throw_if_interrupted();
  BenchRow failed{"fem", contest.name, "", "CPU s", 0, "CalculiX"};
  failed.ok = false;
  failed.note = e.what();
  findings.rows.push_back(failed);
}

void bench_calculix(const Options& options, Findings& findings) {
  if (calculix::program().empty())
    return findings.remarks.push_back("ccx is not on PATH (Debian: calculix-ccx): no rows against CalculiX");
  for (Contest contest : contests) {
    if (options.quick) {
      contest.calculix = 4;
      contest.ours = {2, 4};
      contest.truth = {2, 4, 8};
    }
    run(contest, findings);
    if (options.quick) break;
  }
}

}  // namespace

Json bench_fem(const Options& options, Findings& findings) {
  if (!fem::available()) {
    findings.remarks.push_back(
        "springproof-fem is neither beside this program nor named by SPRINGPROOF_FEM_PROGRAM: no rows of the "
        "reference");
    return nullptr;
  }
  const TemporaryFolder folder;
  std::vector<std::string> arguments = {"--bench", "--json", (folder.path / "fem.json").string()};
  if (options.quick) arguments.insert(arguments.end(), {"--bench-cells", "8"});
  arguments.insert(arguments.end(), options.fem_arguments.begin(), options.fem_arguments.end());
  const int status = fem::run_program(arguments);
  throw_if_interrupted();
  if (status != 0) throw std::runtime_error(fmt::format("springproof-fem --bench ended with {}", status));
  const Json figures = Json::parse(text_of_file(folder.path / "fem.json"));
  for (const Json& run : figures.at("rows")) findings.rows.push_back(run_row(run));
  for (const auto& [what, value] : figures.at("ratios").items())
    findings.rows.push_back({"fem", what, "", "ratio", value.get<double>(), "", 0, target_of(figures, what)});
  bench_calculix(options, findings);
  return figures;
}

}  // namespace springproof::bench
