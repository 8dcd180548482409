#include "fem_reference/bench.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "fem_reference/solve_grid.h"
#include "problem/files/files.h"
#include "problem/processes/child.h"
#include "problem/system/streams.h"

namespace springproof::fem {
namespace {

struct BenchRow {
  std::string name;
  int cells;
  double poisson_ratio;
  std::string element;
  Method method;
  bool finite = false;
  // measured
  bool ok = false;
  long unknowns = 0;
  int iterations = 0;
  double seconds = 0, memory_MiB = 0, force = 0;
  std::string form{};
};

// A cube between clamped plates, compressed by 5 %: singular at the edges, as the experiments are.
GridProblem compressed_cube(const BenchRow& row) {
  GridProblem problem;
  int coarse = row.cells;
  const bool hierarchy = row.element[0] == 'q' && row.method == Method::automatic;
  for (; hierarchy && coarse % 2 == 0 && coarse > 2; coarse /= 2) ++problem.refinements;
  problem.coarse = block_mesh(Vec3::Constant(5), {coarse, coarse, coarse});
  problem.degree = row.element[1] - '0';
  problem.method = row.method;
  problem.law = row.finite ? "hencky" : "linear";
  problem.material = {1e4, row.poisson_ratio, 1000};
  problem.loads = {PrescribedDisplacement{"z_min", {0.0, 0.0, 0.0}},
                   PrescribedDisplacement{"z_max", {0.0, 0.0, -0.25}}};
  problem.points = NodalVectors(0, 3);
  problem.tolerance = 1e-8;
  return problem;
}

// Each run in a child process, so that the peak memory is that of this run.
void measure(BenchRow& row) {
  to_stderr("{}, {}^3 cells, nu = {} ...\n", row.name, row.cells, row.poisson_ratio);
  const auto work = [&] {
    const Solution s = solve_grid(compressed_cube(row));
    const nlohmann::json answer = {{"ok", s.ok},
                                   {"unknowns", s.degrees_of_freedom},
                                   {"iterations", s.iterations},
                                   {"seconds", s.seconds},
                                   {"memory_MiB", s.memory_MiB},
                                   {"form", s.form},
                                   {"force", s.reactions.empty() ? 0.0 : s.reactions[0].force[2]}};
    return answer.dump();
  };
  nlohmann::json answer;
  try {
    answer = nlohmann::json::parse(in_child(work));
  } catch (const std::runtime_error& e) {
    row.form = e.what();
    return;
  }
  row.ok = answer.at("ok");
  row.form = answer.at("form");
  row.unknowns = answer.at("unknowns");
  row.iterations = answer.at("iterations");
  row.seconds = answer.at("seconds");
  row.memory_MiB = answer.at("memory_MiB");
  row.force = answer.at("force");
}

std::string seconds_per(const BenchRow& row, double per) {
  return fmt::format("{:.2f}", row.unknowns > 0 ? row.seconds / double(row.unknowns) * per : 0.0);
}

nlohmann::json to_json(const BenchRow& row) {
  return {{"name", row.name},
          {"cells", row.cells},
          {"poisson_ratio", row.poisson_ratio},
          {"ok", row.ok},
          {"form", row.form},
          {"unknowns", row.unknowns},
          {"iterations", row.iterations},
          {"cpu_seconds", row.seconds},
          {"memory_MiB", row.memory_MiB},
          {"force_N", row.force}};
}

}  // namespace

void bench(const BenchOptions& options) {
  const int n = options.cells;
  std::vector<BenchRow> rows = {{"Q2, a half of the cells", n / 2, 0.25, "q2", Method::automatic},
                                {"Q2", n, 0.25, "q2", Method::automatic},
                                {"Q2, 5/3 of the cells", n * 5 / 3 / 8 * 8, 0.25, "q2", Method::automatic},
                                {"Q2, near 1/2", n, 0.4999, "q2", Method::automatic},
                                {"Q2, finite strain", n / 2, 0.25, "q2", Method::automatic, true},
                                {"Q2 assembled, p-multigrid", n, 0.25, "q2", Method::assembled}};
  if (options.baseline) rows.push_back({"Q2 assembled, PETSc CG + GAMG", n, 0.25, "q2", Method::assembled_gamg});
  for (BenchRow& row : rows) measure(row);

  to_stdout("{}\n\n{:<30} {:>6} {:>7} {:>10} {:>5} {:>8} {:>10} {:>8} {:>12}\n", library_versions(), "run", "cells",
            "nu", "unknowns", "iter.", "CPU s", "us/unknown", "MiB", "force [N]");
  for (const BenchRow& row : rows)
    to_stdout("{:<30} {:>4}^3 {:>7} {:>10} {:>5} {:>8.2f} {:>10} {:>8.0f} {:>12.4f}{}\n", row.name, row.cells,
              row.poisson_ratio, row.unknowns, row.iterations, row.seconds, seconds_per(row, 1e6), row.memory_MiB,
              row.force, row.ok ? "" : "  FAILED: " + row.form);

  nlohmann::json ratios, targets = nlohmann::json::object();
  const auto ratio = [&](const std::string& what, double value, const std::string& sense = {}, double limit = 0) {
    to_stdout("{:<62} {:>7.2f}   {}\n", what, value,
              sense.empty() ? "" : fmt::format("{} {:g}", sense == "at_most" ? "at most" : "at least", limit));
    ratios[what] = value;
    if (!sense.empty()) targets[what] = {{sense, limit}};
  };
  to_stdout("\n");
  const BenchRow &half = rows[0], &full = rows[1], &large = rows[2], &stiff = rows[3], &assembled = rows[5];
  const double cost = full.seconds / double(full.unknowns);
  ratio("cost per unknown, smallest over middle (flat: 1)", half.seconds / double(half.unknowns) / cost);
  ratio("cost per unknown, largest over middle (flat: 1)", large.seconds / double(large.unknowns) / cost);
  ratio("nu = 0.4999 over nu = 0.25", stiff.seconds / full.seconds, "at_most", 5);
  ratio("assembled p-multigrid over matrix-free, time", assembled.seconds / full.seconds);
  if (options.baseline) {
    const BenchRow& baseline = rows[6];
    ratio("assembled PETSc CG + GAMG over matrix-free, time", baseline.seconds / full.seconds, "at_least", 15);
    ratio("matrix-free over assembled PETSc CG + GAMG, memory", full.memory_MiB / baseline.memory_MiB, "at_most", 0.25);
    ratio("assembled PETSc CG + GAMG over assembled p-multigrid, time", baseline.seconds / assembled.seconds);
  }
  if (options.json_file.empty()) return;
  nlohmann::json all = {{"library", library_versions()}, {"ratios", ratios}, {"targets", targets}};
  for (const BenchRow& row : rows) all["rows"].push_back(to_json(row));
  write_named_file(options.json_file, all.dump(2) + "\n");
}

}  // namespace springproof::fem
