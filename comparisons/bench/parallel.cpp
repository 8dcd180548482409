#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <thread>

#include "comparisons/bench/benches.h"
#include "comparisons/bench/interrupt.h"
#include "comparisons/run/find_cases.h"
#include "problem/system/child.h"
#include "problem/system/files.h"
#include "problem/system/streams.h"

namespace springproof::bench {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

/// A block of 1 x 1 x `length` m under a traction on its side.
std::string block_case(int length) {
  return fmt::format(R"([body]
geo = "block.geo"
size_m = [1, 1, {0}]
cells = [1, 1, {0}]
[material]
youngs_modulus_Pa = 1e4
poisson_ratio = 0.3
density_kg_m3 = 10
[[load]]
on = "z_min"
displacement_m = [0, 0, 0]
[[load]]
on = "x_max"
traction_Pa = [10, 2, 0]
)",
                     length);
}

/// What one process does; on more of them the same, or as much for each.
struct Task {
  std::string name;
  int cells;                           ///< across the block; of a body about so many in all
  std::vector<std::string> arguments;  ///< of springproof-lattice
  bool body = false;                   ///< the rabbit in parts instead of the block in slabs
};

struct Programs {
  fs::path mpirun, lattice;
};

struct Run {
  double seconds = 0, set_up = 0, MiB = 0;
  std::string note;
};

/// @param length of the block, which has so many times the cells
Run run(const Programs& programs, const Task& task, int processes, int length) {
  const TemporaryFolder folder;
  fs::path file = folder.path / "case.toml";
  std::vector<std::string> arguments = {"-q", "-np", std::to_string(processes), programs.lattice.string()};
  if (task.body) {
    file = find_cases({"bodies/rabbit"}).front();
    arguments.insert(arguments.end(), {file.string(), "--voxels", std::to_string(task.cells)});
  } else {
    const std::string n = std::to_string(task.cells);
    write_file(file, block_case(length));
    arguments.insert(arguments.end(), {file.string(), "--cells", n, n, std::to_string(task.cells * length)});
  }
  arguments.insert(arguments.end(), task.arguments.begin(), task.arguments.end());
  const fs::path json = folder.path / "result.json", said = folder.path / "said";
  arguments.insert(arguments.end(), {"--json", json.string()});
  const ChildEnd end = run_child({programs.mpirun, arguments, {}, said, said, 600, true});
  throw_if_interrupted();
  if (!end.ok()) throw std::runtime_error(fmt::format("{}: {}", words_for(end, 600), trimmed(text_of_file(said))));
  const Json r = Json::parse(text_of_file(json));
  Run out{r.at("solve_seconds"), r.at("set_up_seconds"), r.at("MiB_per_process"), ""};
  out.note = r.contains("steps")
                 ? fmt::format("{} steps", r.at("steps").get<long>())
                 : fmt::format("{}, {} iterations", r.at("solver").get<std::string>(), r.at("iterations").get<int>());
  return out;
}

/// Rows of a task on `processes` beside one; the least of runs that alternate.
void measure(const Programs& programs, const Task& task, int processes, bool quick, Findings& findings) try {
  to_stderr("parallel: {}, {} processes ...\n", task.name, processes);
  enum { one, strong, weak, kinds };
  std::array<Run, kinds> best;
  for (int sample = 0; sample < (quick ? 1 : 3); ++sample)
    for (int kind = one; kind < (task.body ? weak : kinds); ++kind) {
      const Run now = run(programs, task, kind == one ? 1 : processes, kind == weak ? processes : 1);
      if (sample == 0 || now.seconds < best[kind].seconds) best[kind] = now;
    }
  const std::string size = task.body ? fmt::format("{} cells", task.cells) : fmt::format("{}^3", task.cells),
                    on = fmt::format("{} processes", processes);
  const auto row = [&](int kind, const std::string& what, const std::string& of, Target target) {
    BenchRow r{"parallel",
               fmt::format("{}, {}", task.name, what),
               of,
               "wall s",
               best[kind].seconds,
               "one process",
               best[one].seconds,
               target};
    r.note = fmt::format("{}; {}; set-up {:.2f} s, on one process {:.2f} s; {:.0f} MiB per process, {:.0f} on one", on,
                         best[kind].note, best[kind].set_up, best[one].set_up, best[kind].MiB, best[one].MiB);
    findings.rows.push_back(r);
    findings.rows.push_back({"parallel", r.what, of, "MiB per process", best[kind].MiB, "one process", best[one].MiB});
  };
  row(strong, on + ", as many cells", size, task.body ? Target{} : at_least(0.75 * processes));
  if (!task.body)
    row(weak, on + ", as many each", fmt::format("{0}x{0}x{1}", task.cells, task.cells * processes), at_least(0.75));
} catch (const Interrupted&) {
  throw;
} catch (const std::runtime_error& e) {
  throw_if_interrupted();
  BenchRow failed{"parallel", task.name, "", "wall s", 0, "one process"};
  failed.ok = false;
  failed.note = e.what();
  findings.rows.push_back(failed);
}

}  // namespace

void bench_parallel(const BenchOptions& options, Findings& findings) {
  const Programs programs{program_on_path("mpirun"),
                          find_program("springproof-lattice", "SPRINGPROOF_LATTICE_PROGRAM")};
  if (programs.mpirun.empty() || programs.lattice.empty())
    return findings.remarks.push_back(fmt::format("{} is not there: no rows of several processes",
                                                  programs.mpirun.empty() ? "mpirun" : "springproof-lattice"));
  for (const char* allow : {"OMPI_ALLOW_RUN_AS_ROOT", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM"}) setenv(allow, "1", 1);
  const bool quick = options.quick;
  std::vector<Task> tasks = {
      {"block in equilibrium", quick ? 24 : 64, {}},
      {"block in explicit steps", quick ? 24 : 64, {"--steps", quick ? "50" : "200"}},
  };
  if (!quick)  // it takes longer to mesh than to solve
    tasks.push_back({"rabbit of cut cells", 20000, {"--model", "hybmss_avg", "--tolerance", "1e-8"}, true});
  const int cores = static_cast<int>(std::thread::hardware_concurrency());
  for (const Task& task : tasks)
    for (const int processes : {2, 4})
      if (processes <= cores || processes == 2) measure(programs, task, processes, quick, findings);
  if (cores < 4) findings.remarks.push_back(fmt::format("4 processes: this machine has {} cores", cores));
}

}  // namespace springproof::bench
