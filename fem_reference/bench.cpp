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
  Method method = Method::automatic;
  bool finite = false;
  // measured
  bool ok = false;
  long unknowns = 0;
  int iterations = 0;
  double cpu_seconds = 0, memory_MiB = 0, force_N = 0;
  std::string form{};

  double seconds_per_unknown() const { return unknowns > 0 ? cpu_seconds / double(unknowns) : 0; }
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(BenchRow, name, cells, poisson_ratio, ok, form, unknowns, iterations, cpu_seconds,
                                   memory_MiB, force_N)

// A cube between clamped plates, compressed by 5 %: singular at the edges, as the experiments are.
GridProblem compressed_cube(const BenchRow& row) {
  GridProblem problem;
  int coarse = row.cells;
  for (; row.method == Method::automatic && coarse % 2 == 0 && coarse > 2; coarse /= 2) ++problem.refinements;
  problem.coarse = block_mesh(Vec3::Constant(5), {coarse, coarse, coarse});
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
    BenchRow measured = row;
    measured.ok = s.ok;
    measured.form = s.form;
    measured.unknowns = s.degrees_of_freedom;
    measured.iterations = s.iterations;
    measured.cpu_seconds = s.seconds;
    measured.memory_MiB = s.memory_MiB;
    measured.force_N = s.reactions.empty() ? 0.0 : s.reactions[0].force[2];
    return nlohmann::json(measured).dump();
  };
  try {
    nlohmann::json::parse(in_child(work)).get_to(row);
  } catch (const std::runtime_error& e) {
    row.form = e.what();
  }
}

}  // namespace

void bench(const BenchOptions& options) {
  const int n = options.cells;
  std::vector<BenchRow> rows = {{"Q2, a half of the cells", n / 2, 0.25},
                                {"Q2", n, 0.25},
                                {"Q2, 5/3 of the cells", n * 5 / 3 / 8 * 8, 0.25},
                                {"Q2, near 1/2", n, 0.4999},
                                {"Q2, finite strain", n / 2, 0.25, Method::automatic, true},
                                {"Q2 assembled, p-multigrid", n, 0.25, Method::assembled}};
  if (options.baseline) rows.push_back({"Q2 assembled, PETSc CG + GAMG", n, 0.25, Method::assembled_gamg});
  for (BenchRow& row : rows) measure(row);

  to_stdout("{}\n\n{:<30} {:>6} {:>7} {:>10} {:>5} {:>8} {:>10} {:>8} {:>12}\n", library_versions(), "run", "cells",
            "nu", "unknowns", "iter.", "CPU s", "us/unknown", "MiB", "force [N]");
  for (const BenchRow& row : rows)
    to_stdout("{:<30} {:>4}^3 {:>7} {:>10} {:>5} {:>8.2f} {:>10.2f} {:>8.0f} {:>12.4f}{}\n", row.name, row.cells,
              row.poisson_ratio, row.unknowns, row.iterations, row.cpu_seconds, 1e6 * row.seconds_per_unknown(),
              row.memory_MiB, row.force_N, row.ok ? "" : "  FAILED: " + row.form);

  nlohmann::json ratios, targets = nlohmann::json::object();
  const auto ratio = [&](const std::string& what, double value, const std::string& sense = {}, double limit = 0) {
    to_stdout("{:<62} {:>7.2f}   {}\n", what, value,
              sense.empty() ? "" : fmt::format("{} {:g}", sense == "at_most" ? "at most" : "at least", limit));
    ratios[what] = value;
    if (!sense.empty()) targets[what] = {{sense, limit}};
  };
  to_stdout("\n");
  const BenchRow &half = rows[0], &full = rows[1], &large = rows[2], &stiff = rows[3], &assembled = rows[5];
  const double cost = full.seconds_per_unknown();
  ratio("cost per unknown, smallest over middle (flat: 1)", half.seconds_per_unknown() / cost);
  ratio("cost per unknown, largest over middle (flat: 1)", large.seconds_per_unknown() / cost);
  ratio("nu = 0.4999 over nu = 0.25", stiff.cpu_seconds / full.cpu_seconds, "at_most", 5);
  ratio("assembled p-multigrid over matrix-free, time", assembled.cpu_seconds / full.cpu_seconds);
  if (options.baseline) {
    const BenchRow& baseline = rows[6];
    ratio("assembled PETSc CG + GAMG over matrix-free, time", baseline.cpu_seconds / full.cpu_seconds, "at_least", 15);
    ratio("matrix-free over assembled PETSc CG + GAMG, memory", full.memory_MiB / baseline.memory_MiB, "at_most", 0.25);
    ratio("assembled PETSc CG + GAMG over assembled p-multigrid, time", baseline.cpu_seconds / assembled.cpu_seconds);
  }
  if (options.json_file.empty()) return;
  const nlohmann::json all = {
      {"library", library_versions()}, {"ratios", ratios}, {"targets", targets}, {"rows", rows}};
  write_named_file(options.json_file, all.dump(2) + "\n");
}

}  // namespace springproof::fem
